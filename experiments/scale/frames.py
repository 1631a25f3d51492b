"""Rendered nodes of a map and pictures taken beside them, with their features."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.rendered.features import Tick, cache_folder, kept_features
from experiments.scale.poses import SPACING_M, node_poses, query_poses
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world


@dataclass(frozen=True, eq=False)
class Seen:
    """A picture: where it was taken, its features, and how far apart the nodes of its world are."""

    world: str
    spacing_m: float
    pose: Pose
    features: FeatureSet


@dataclass(frozen=True, eq=False)
class WorldFrames:
    """Nodes in a world, and pictures taken beside them."""

    nodes: list[Seen]
    queries: list[Seen]


def frames_of(
    world_name: str, pipeline: Pipeline, queries: int, seed: int, cache: Path, tick: Tick
) -> WorldFrames:
    """Read what is kept, render the rest and keep it; `tick` hears how far it is."""
    world = load_world(world_name)
    space, rng = free_space(world), np.random.default_rng(seed)
    spacing_m = SPACING_M[world.environment]
    nodes = node_poses(space, spacing_m, rng)
    asked = query_poses(space, nodes, spacing_m, queries, rng)
    folder = cache_folder(cache, "scale", world, pipeline, seed, spacing_m)

    def seen(poses: list[Pose], name: str) -> list[Seen]:
        found = kept_features(world, pipeline, poses, folder / name, tick)
        return [Seen(world.name, spacing_m, *each) for each in zip(poses, found, strict=True)]

    return WorldFrames(seen(nodes, "places"), seen(asked, f"queries-{queries}"))
