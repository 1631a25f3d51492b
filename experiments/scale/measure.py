"""One map: how long it takes to load it, to find a node in it and to follow a way."""

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from experiments.bench.stages import percentiles
from experiments.rendered.features import as_message
from experiments.scale.frames import Seen
from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import match_candidates, verify_candidates
from services.features.matching.verification import Candidate, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.matching import MatchRequest, NodeMatch

TRACKED = 4
"""Nodes compared on a way: those ahead and around (services/planner/travel/following/lookahead.py)."""


@dataclass(frozen=True)
class Found:
    """Answer to one picture."""

    node_id: int
    inliers: int
    ms: float


def load(nodes: Iterable[FeatureSet], pipeline: Pipeline) -> tuple[MapFeatures, float]:
    """Nodes of a map, numbered from zero, and the seconds it took to take them over."""
    messages = (as_message(each, pipeline.identity) for each in nodes)
    kept = MapFeatures.of(pipeline)
    took_s = 0.0
    for node_id, message in enumerate(messages):
        start_s = time.perf_counter()
        kept.put(node_id, message)
        took_s += time.perf_counter() - start_s
    start_s = time.perf_counter()
    kept.prepare()
    return kept, took_s + time.perf_counter() - start_s


def localise(queries: Sequence[Seen], kept: MapFeatures, pipeline: Pipeline) -> list[Found]:
    """The most similar node of each picture as the running service finds it, verified."""
    return [
        _ask(query, MatchRequest(seq=n, map="scale", best_k=1), kept, pipeline)
        for n, query in enumerate(queries)
    ]


def track(
    queries: Sequence[Seen], near: Sequence[Sequence[int]], kept: MapFeatures, pipeline: Pipeline
) -> list[Found]:
    """Each picture compared with the few nodes given for it, verified."""
    return [
        _ask(query, MatchRequest(seq=n, map="scale", node_ids=tuple(ids)), kept, pipeline)
        for n, (query, ids) in enumerate(zip(queries, near, strict=True))
    ]


def _ask(query: Seen, request: MatchRequest, kept: MapFeatures, pipeline: Pipeline) -> Found:
    message = as_message(query.features, pipeline.identity)
    start_s = time.perf_counter()
    answers: tuple[NodeMatch, ...] = verify_candidates(
        pipeline, request, match_candidates(pipeline, request, message, kept)
    )
    took_ms = (time.perf_counter() - start_s) * 1e3
    best = answers[0] if answers else None
    return Found(-1 if best is None else best.node_id, 0 if best is None else best.inliers, took_ms)


def exhaustive(query: Seen, nodes: Sequence[FeatureSet], pipeline: Pipeline) -> tuple[np.ndarray, float]:
    """Verified matches with every node of the map, and the milliseconds that took."""
    start_s = time.perf_counter()
    pairs = pipeline.matcher.match(query.features, nodes)
    inliers = [
        verify(query.features, Candidate(n, node), rows, 0, pipeline.verification, False).inliers
        for n, (node, rows) in enumerate(zip(nodes, pairs, strict=True))
    ]
    return np.array(inliers), (time.perf_counter() - start_s) * 1e3


def times(found: Sequence[Found], name: str) -> dict[str, Any]:
    """Median and 99th percentile."""
    return {f"{name}_{key}": value for key, value in percentiles([each.ms for each in found]).items()}
