"""What packing the features of nodes costs in verified matches, for one pipeline after the other."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from experiments.matching.study import pipeline_with_weights
from experiments.rendered.features import features_seen
from experiments.scale.frames import SPACING_M, node_poses, query_poses
from services.features.map_features.packing import Packing
from services.features.matching.verification import Candidate, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.launcher.terminal.output import rounded
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile

EXTRACTORS = ("sift", "orb", "beblid", "tfeat", "mkd", "aliked-t16")
SCATTER_DRAWS = 3
"""Draws of the verification per pair: one alone scatters more than packing loses."""
MEASURED = ("matches", "lost", "descriptor_bytes", "bytes_per_word")
Row = dict[str, Any]
Pair = tuple[FeatureSet, FeatureSet]


def packing_losses(world: WorldFile, pictures: int, seed: int, tick: Callable[[str], None]) -> Iterator[Row]:
    """A row for each extractor: matches before and after packing; None where its weights are absent."""
    poses = _pairs(world, pictures, seed)
    for name in EXTRACTORS:
        tick(f"packed features of {name}")
        pipeline = pipeline_with_weights(name, "equirectangular", "mutual_ratio")
        if pipeline is None:
            yield {"extractor": name, "pictures": 0, **dict.fromkeys(MEASURED)}
            continue
        look = features_seen(world, pipeline)
        yield {"extractor": name, **loss(pipeline, [(look(here), look(node)) for here, node in poses])}


def loss(pipeline: Pipeline, pairs: list[Pair]) -> Row:
    """Verified matches of pictures with nodes, before and after packing the nodes."""
    kept = sum(_matches(pipeline, picture, node) for picture, node in pairs)
    packed = sum(_matches(pipeline, picture, _packed(pipeline, node)) for picture, node in pairs)
    descriptor = pairs[0][1].descriptors[:1]
    record = _packing(pipeline, pairs[0][1]).record
    return {
        "pictures": len(pairs),
        "matches": rounded(kept / len(pairs), 1),
        "lost": rounded(1.0 - packed / max(kept, 1e-9), 4),
        "descriptor_bytes": descriptor.nbytes,
        "bytes_per_word": rounded(record.itemsize / pipeline.profile.keypoints, 1),
    }


def _pairs(world: WorldFile, count: int, seed: int) -> list[tuple[Pose, Pose]]:
    """Poses of pictures, each with the nearest node's."""
    space, rng, spacing_m = free_space(world), np.random.default_rng(seed), SPACING_M[world.environment]
    nodes = node_poses(space, spacing_m, rng)

    def nearest(to: Pose) -> Pose:
        return min(nodes, key=lambda node: math.dist((to.x_m, to.y_m), (node.x_m, node.y_m)))

    return [(pose, nearest(pose)) for pose in query_poses(space, nodes, spacing_m, count, rng)]


def _matches(pipeline: Pipeline, picture: FeatureSet, node: FeatureSet) -> float:
    (rows,) = pipeline.matcher.match(picture, [node])
    draws = [
        verify(picture, Candidate(0, node), rows, seq, pipeline.verification, False).inliers
        for seq in range(SCATTER_DRAWS)
    ]
    return float(np.mean(draws))


def _packed(pipeline: Pipeline, node: FeatureSet) -> FeatureSet:
    packing = _packing(pipeline, node)
    return packing.unpack(packing.pack(node))


def _packing(pipeline: Pipeline, node: FeatureSet) -> Packing:
    return Packing.of(node, pipeline.profile.keypoints, pipeline.extractor.distance)
