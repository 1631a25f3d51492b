"""Features of rendered pose pairs, kept on disk so that a study can be run again at once.

Uses the pure code of `services.features` and the simulator in this process: no stack is needed.
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from experiments.studies.pairs import APART_M, PosePair
from services.features.interfaces import FeatureSet
from services.features.pipeline import Pipeline
from services.features.verification import feature_set
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.settings import CameraSettings, SimulationSettings
from simulator.world_file import WorldFile

FeaturePair = tuple[FeatureSet, FeatureSet]
WIDTH_PX = 1024
ARRAYS = ("lonlat_rad", "scores", "descriptors")


def camera_settings() -> SimulationSettings:
    """The camera of the running stack: docker-compose.yml sets the same width."""
    return SimulationSettings(camera=CameraSettings(width_px=WIDTH_PX))


def cache_folder(
    root: Path,
    world: WorldFile,
    pipeline: Pipeline,
    seed: int,
    apart_m: tuple[float, float] = APART_M,
) -> Path:
    """Folder of one kind of pairs: another world, camera, pipeline or seed is another folder."""
    settings = camera_settings()
    text = f"{world.model_dump_json()}|{settings.camera.model_dump_json()}|{asdict(pipeline.profile)}|{seed}"
    text += "" if apart_m == APART_M else f"|{apart_m}"
    return root / f"pairs-{world.name}-{pipeline.identity}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"


def features_of_pairs(
    pairs: Sequence[PosePair],
    world: WorldFile,
    pipeline: Pipeline,
    folder: Path,
    tick: Callable[[], None],
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


def eye(world: WorldFile, pipeline: Pipeline) -> Callable[[Pose], FeatureSet]:
    """What the pipeline sees of a world from any pose; loads SAPIEN, where a picture is missing."""
    from simulator.simulation import Simulation

    simulation = Simulation(world, camera_settings())

    def look(pose: Pose) -> FeatureSet:
        picture = simulation.panorama_at(pose.x_m, pose.y_m, pose.yaw_rad)
        height, width = picture.shape[:2]
        frame = Frame(
            robot="study", encoding="bgr8", width_px=width, height_px=height, data=picture.tobytes()
        )
        return feature_set(pipeline.features_of(frame))

    return look


def _save(path: Path, pair: FeaturePair) -> None:
    arrays = {f"{name}_{side}": getattr(pair[side], name) for side in (0, 1) for name in ARRAYS}
    new = path.with_suffix(".new.npz")
    np.savez(new, **arrays)
    new.replace(path)


def _load(path: Path) -> FeaturePair:
    with np.load(path, allow_pickle=False) as arrays:
        first, second = (FeatureSet(*(arrays[f"{name}_{side}"] for name in ARRAYS)) for side in (0, 1))
    return first, second
