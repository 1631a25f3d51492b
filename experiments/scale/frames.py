"""Where the nodes of a study lie and its pictures are taken, and the features of both."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.rendered.features import Tick, cache_folder, kept_features
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

SPACING_M = {"indoor": 0.6, "outdoor": 1.5}
"""Distance of neighbouring nodes, as exploring leaves them: 76 in the apartment, 468 in the village."""

NEAR = (0.3, 1.2)
"""A picture is taken within these parts of the spacing from a node, in free sight of it."""


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


def node_poses(space: FreeSpace, spacing_m: float, rng: np.random.Generator) -> list[Pose]:
    """As many poses as fit on the free floor, none nearer than `spacing_m` to another, in random order."""
    cells: dict[tuple[int, int], list[tuple[float, float]]] = {}
    kept = []
    for x_m, y_m in rng.permutation(space.centres_m()).tolist():
        column, row = int(x_m // spacing_m), int(y_m // spacing_m)
        around = [(column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        if all(math.dist((x_m, y_m), other) >= spacing_m for cell in around for other in cells.get(cell, ())):
            cells.setdefault((column, row), []).append((x_m, y_m))
            kept.append(Pose(x_m=x_m, y_m=y_m, yaw_rad=float(rng.uniform(-math.pi, math.pi))))
    return kept


def query_poses(
    space: FreeSpace, nodes: list[Pose], spacing_m: float, count: int, rng: np.random.Generator
) -> list[Pose]:
    """Poses beside nodes, turned at random."""
    found: list[Pose] = []
    while len(found) < count:
        node = nodes[int(rng.integers(len(nodes)))]
        bearing = float(rng.uniform(-math.pi, math.pi))
        distance_m = float(rng.uniform(*NEAR)) * spacing_m
        end = (node.x_m + distance_m * math.cos(bearing), node.y_m + distance_m * math.sin(bearing))
        if space.is_free(end) and space.line_of_sight((node.x_m, node.y_m), end):
            found.append(Pose(x_m=end[0], y_m=end[1], yaw_rad=float(rng.uniform(-math.pi, math.pi))))
    return found
