"""Words of rendered places and pictures, kept on disk: rendering them takes most of the study's time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.scale.poses import SPACING_M, place_poses, query_poses
from experiments.studies.rendered_views import cache_folder, eye
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world

CHUNK = 50
"""Pictures per file: what an interruption loses at most."""
Tick = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Seen:
    """A picture: where it was taken, its words, and how far apart the places of its world are."""

    world: str
    spacing_m: float
    pose: Pose
    words: FeatureSet


@dataclass(frozen=True, eq=False)
class WorldFrames:
    """Places of a world, and pictures taken beside them."""

    places: list[Seen]
    queries: list[Seen]


def frames_of(
    world_name: str, pipeline: Pipeline, queries: int, seed: int, cache: Path, tick: Tick
) -> WorldFrames:
    """Read what is kept, render the rest and keep it; `tick` hears how far it is."""
    world = load_world(world_name)
    space, rng = free_space(world), np.random.default_rng(seed)
    spacing_m = SPACING_M[world.environment]
    places = place_poses(space, spacing_m, rng)
    asked = query_poses(space, places, spacing_m, queries, rng)
    folder = cache_folder(cache, "scale", world, pipeline, seed, spacing_m)
    return WorldFrames(
        _seen(world, pipeline, places, folder / "places", tick),
        _seen(world, pipeline, asked, folder / f"queries-{queries}", tick),
    )


def _seen(
    world: WorldFile, pipeline: Pipeline, poses: Sequence[Pose], folder: Path, tick: Tick
) -> list[Seen]:
    folder.mkdir(parents=True, exist_ok=True)
    look: Callable[[Pose], FeatureSet] | None = None
    found: list[FeatureSet] = []
    for start in range(0, len(poses), CHUNK):
        path = folder / f"{start:06d}-{min(CHUNK, len(poses) - start)}.npz"
        if not path.exists():
            look = look or eye(world, pipeline)
            _save(path, [look(pose) for pose in poses[start : start + CHUNK]])
        found += _load(path)
        tick(f"{world.name}: {len(found)} of {len(poses)} pictures")
    spacing_m = SPACING_M[world.environment]
    return [Seen(world.name, spacing_m, pose, words) for pose, words in zip(poses, found, strict=True)]


def _save(path: Path, words: Sequence[FeatureSet]) -> None:
    new = path.with_suffix(".new.npz")
    np.savez(
        new,
        counts=np.array([len(each) for each in words]),
        lonlat_rad=np.concatenate([each.lonlat_rad for each in words]),
        scores=np.concatenate([each.scores for each in words]),
        descriptors=np.concatenate([each.descriptors for each in words]),
    )
    new.replace(path)


def _load(path: Path) -> list[FeatureSet]:
    with np.load(path, allow_pickle=False) as kept:
        ends = np.cumsum(kept["counts"])[:-1]
        columns = [np.split(kept[name], ends) for name in ("lonlat_rad", "scores", "descriptors")]
    return [FeatureSet(*each) for each in zip(*columns, strict=True)]
