"""Features of rendered pose pairs, kept on disk so that a study can be run again at once.

Uses the pure code of `services.features` and the simulator in this process: no stack is needed.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from experiments.studies.pairs import PosePair
from experiments.studies.rendered_views import eye
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from simulator.world.world_file import WorldFile

FeaturePair = tuple[FeatureSet, FeatureSet]
ARRAYS = ("lonlat_rad", "scores", "descriptors")


def features_of_pairs(
    pairs: Sequence[PosePair], world: WorldFile, pipeline: Pipeline, folder: Path, tick: Callable[[], None]
) -> list[FeaturePair]:
    """Read from `folder` what is there, render the rest and keep it; `tick` is called once per pair."""
    folder.mkdir(parents=True, exist_ok=True)
    look: Callable[[Pose], FeatureSet] | None = None
    found = []
    for number, pair in enumerate(pairs):
        path = folder / f"{number:05d}.npz"
        if not path.exists():
            look = look or eye(world, pipeline)
            _save(path, (look(pair.current), look(pair.target)))
        found.append(_load(path))
        tick()
    return found


def _save(path: Path, pair: FeaturePair) -> None:
    arrays = {f"{name}_{side}": getattr(pair[side], name) for side in (0, 1) for name in ARRAYS}
    new = path.with_suffix(".new.npz")
    np.savez(new, **arrays)
    new.replace(path)


def _load(path: Path) -> FeaturePair:
    with np.load(path, allow_pickle=False) as arrays:
        first, second = (FeatureSet(*(arrays[f"{name}_{side}"] for name in ARRAYS)) for side in (0, 1))
    return first, second
