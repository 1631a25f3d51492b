"""The measurements of `topnav study scale`, one table after the other."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from experiments.scale.frames import Seen, WorldFrames
from experiments.scale.maps import nodes_of
from experiments.scale.measure import TRACKED, Found, exhaustive, load, localise, times, track
from experiments.scale.peers import peers, timed
from experiments.scale.refusal import calibrated, refusal_curve
from services.features.map_features.map_features import MapFeatures
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.launcher.terminal.output import rounded

Row = dict[str, Any]
EXHAUSTIVE_PICTURES = {1000: 60, 10_000: 3}
"""Pictures compared with every node of a map of at most so many nodes: each takes 0.85 s or 8.3 s."""
NEAR_SPACINGS = 2.0
"""Up to the node after the next a picture counts as taken beside it."""


class ScaleStudy:
    """Maps that grow, and the same pictures to be found in each.

    Args:
        frames: of the worlds in the maps.
        foreign: pictures of a world that is in none.
    """

    def __init__(
        self, pipeline: Pipeline, frames: Sequence[WorldFrames], foreign: Sequence[Seen], seed: int
    ) -> None:
        rng = np.random.default_rng(seed)
        self._pipeline, self._foreign, self._seed = pipeline, foreign, seed
        self._nodes = _shuffled([seen for each in frames for seen in each.nodes], rng)
        self._queries = _shuffled([seen for each in frames for seen in each.queries], rng)

    def point(self, count: int) -> tuple[Row, MapFeatures]:
        """Figures of a map of `count` nodes, and the map."""
        rng = np.random.default_rng([self._seed, count])
        real = [seen.features for seen in self._nodes]
        kept, load_s = load(nodes_of(real, count, rng), self._pipeline)
        queries = self._near(count)
        found = localise(queries, kept, self._pipeline)
        near = [_neighbours(answer.node_id, count) for answer in found]
        followed = track(queries, near, kept, self._pipeline)
        truth = self._exhaustive(kept, queries, count)
        row = {
            "nodes": count,
            **times(found, "localise"),
            **times(followed, "track"),
            "right_place": rounded(
                np.mean([self._is_right(f, q) for f, q in zip(found, queries, strict=True)])
            ),
            "bytes_per_node": rounded(kept.size_bytes / count, 0),
            "load_s": rounded(load_s, 2),
            **_against(truth, found),
        }
        return row, kept

    def refusal(self, kept: MapFeatures, count: int) -> Row:
        """Errors of "not in this map" in a map."""
        own = [each.inliers for each in localise(self._near(count), kept, self._pipeline)]
        foreign = [each.inliers for each in localise(self._foreign, kept, self._pipeline)]
        curve = refusal_curve(own, foreign)
        return {"nodes": count, **asdict(calibrated(curve)), "curve": [asdict(each) for each in curve]}

    def peers(self, count: int, asked: int) -> list[Row]:
        """Time and recall@1 of topnav and of others, on the same pictures and the same map of real nodes."""
        nodes = [seen.features for seen in self._nodes[:count]]
        queries = self._near(count)[:asked]
        best = [exhaustive(query, nodes, self._pipeline) for query in queries]
        kept, _ = load(nodes, self._pipeline)
        found = localise(queries, kept, self._pipeline)
        every_ms, ours_ms = ([ms for _, ms in best], [each.ms for each in found])
        rows = [
            ("exhaustive, verified", [int(s.argmax()) for s, _ in best], float(np.median(every_ms))),
            ("topnav", [each.node_id for each in found], float(np.median(ours_ms))),
            *((name, *timed(rank, [q.features for q in queries])) for name, rank in peers(nodes).items()),
        ]
        return [
            {
                "name": name,
                "nodes": len(nodes),
                "ms": rounded(ms, 2),
                "recall_at_1": rounded(
                    np.mean([s[a] >= s.max() for (s, _), a in zip(best, answers, strict=True)])
                ),
            }
            for name, answers, ms in rows
        ]

    def _near(self, count: int) -> list[Seen]:
        """Pictures taken beside a real node that is in a map of `count`."""
        return [
            query for query in self._queries if any(_is_near(query, node) for node in self._nodes[:count])
        ]

    def _is_right(self, found: Found, query: Seen) -> bool:
        real = 0 <= found.node_id < len(self._nodes)
        return real and _is_near(query, self._nodes[found.node_id])

    def _exhaustive(
        self, kept: MapFeatures, queries: Sequence[Seen], count: int
    ) -> list[tuple[np.ndarray, float]]:
        asked = next((n for most, n in EXHAUSTIVE_PICTURES.items() if count <= most), 0)
        nodes: list[FeatureSet] = [kept.features(node_id) for node_id in range(count)] if asked else []
        return [exhaustive(query, nodes, self._pipeline) for query in queries[:asked]]


def _against(truth: list[tuple[np.ndarray, float]], found: Sequence[Found]) -> Row:
    if not truth:
        return {"exhaustive_ms": None, "recall_at_1": None, "exhaustive_pictures": 0}
    same = [s[f.node_id] >= s.max() for (s, _), f in zip(truth, found, strict=False)]
    return {
        "exhaustive_ms": rounded(np.median([ms for _, ms in truth]), 1),
        "recall_at_1": rounded(np.mean(same)),
        "exhaustive_pictures": len(truth),
    }


def _neighbours(node_id: int, count: int) -> list[int]:
    return sorted({(max(node_id, 0) + step) % count for step in range(TRACKED)})


def _is_near(query: Seen, node: Seen) -> bool:
    apart_m = math.dist((query.pose.x_m, query.pose.y_m), (node.pose.x_m, node.pose.y_m))
    return query.world == node.world and apart_m <= NEAR_SPACINGS * query.spacing_m


def _shuffled(seen: list[Seen], rng: np.random.Generator) -> list[Seen]:
    return [seen[k] for k in rng.permutation(len(seen)).tolist()]
