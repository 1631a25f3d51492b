"""What packing the words of places costs in verified matches, for one pipeline after the other."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from experiments.matching.study import pipeline_with_weights
from experiments.scale.poses import SPACING_M, place_poses, query_poses
from experiments.studies.rendered_views import eye
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
        tick(f"packed words of {name}")
        pipeline = pipeline_with_weights(name, "equirectangular", "mutual_ratio")
        if pipeline is None:
            yield {"extractor": name, "pictures": 0, **dict.fromkeys(MEASURED)}
            continue
        look = eye(world, pipeline)
        yield {"extractor": name, **loss(pipeline, [(look(here), look(place)) for here, place in poses])}


def loss(pipeline: Pipeline, pairs: list[Pair]) -> Row:
    """Verified matches of pictures with places, before and after packing the places."""
    kept = sum(_matches(pipeline, picture, place) for picture, place in pairs)
    packed = sum(_matches(pipeline, picture, _packed(pipeline, place)) for picture, place in pairs)
    word = pairs[0][1].descriptors[:1]
    record = _packing(pipeline, pairs[0][1]).record
    return {
        "pictures": len(pairs),
        "matches": rounded(kept / len(pairs), 1),
        "lost": rounded(1.0 - packed / max(kept, 1e-9), 4),
        "descriptor_bytes": word.nbytes,
        "bytes_per_word": rounded(record.itemsize / pipeline.profile.keypoints, 1),
    }


def _pairs(world: WorldFile, count: int, seed: int) -> list[tuple[Pose, Pose]]:
    """Poses of pictures, each with the nearest place's."""
    space, rng, spacing_m = free_space(world), np.random.default_rng(seed), SPACING_M[world.environment]
    places = place_poses(space, spacing_m, rng)

    def nearest(to: Pose) -> Pose:
        return min(places, key=lambda place: math.dist((to.x_m, to.y_m), (place.x_m, place.y_m)))

    return [(pose, nearest(pose)) for pose in query_poses(space, places, spacing_m, count, rng)]


def _matches(pipeline: Pipeline, picture: FeatureSet, place: FeatureSet) -> float:
    (rows,) = pipeline.matcher.match(picture, [place])
    draws = [
        verify(picture, Candidate(0, place), rows, seq, pipeline.verification, False).inliers
        for seq in range(SCATTER_DRAWS)
    ]
    return float(np.mean(draws))


def _packed(pipeline: Pipeline, place: FeatureSet) -> FeatureSet:
    packing = _packing(pipeline, place)
    return packing.unpack(packing.pack(place))


def _packing(pipeline: Pipeline, place: FeatureSet) -> Packing:
    return Packing.of(place, pipeline.profile.keypoints, pipeline.extractor.distance)
