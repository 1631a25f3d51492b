"""The thesis's failures that show in pictures: edges between look-alike nodes, headings that are wrong."""

import math
from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from experiments.rendered.features import cache_folder
from experiments.rendered.headings import PairResult, judge_pairs
from experiments.rendered.pairs import APART_M, PosePair, draw_pair
from services.features.matching.verification import feature_set
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.maps import require_map
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.truth_file import load_truth, truth_path
from services.launcher.terminal.output import rounded
from services.planner.profiles import Profile
from shared.messages.maps import MapRequest
from shared.messages.simulation import Pose
from shared.topics import MAP
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

WRONG_RAD = math.radians(45.0)
"""An eighth of a turn: such a heading leads past a door one metre wide and one ahead."""

READ_TIMEOUT_S = 60.0
"""The features of a whole village are 11 MB: 468 nodes of 23 kB (deploy/MEASURED.md)."""


Row = dict[str, Any]


def wrong_headings(
    data_dir: Path, world_name: str, what: str, centre_m: tuple[float, float], radius_m: float, pairs: int
) -> Row:
    """Share of headings more than 45 degrees off between frames round a spot.

    The thesis's choice (methods 1 and 4 by the histogram, raw matches) is method 4 here, its best one.
    """
    world = load_world(world_name)
    pipeline = Pipeline(find_profile("sift"))
    drawn = _near(free_space(world), centre_m, radius_m, pairs, np.random.default_rng(1))
    folder = cache_folder(data_dir / "cache", what.replace(" ", "-"), world, pipeline, 1)
    judged = judge_pairs(drawn, world, pipeline, folder, lambda _: None)
    return {
        "failure": what,
        "world": world_name,
        "pairs": pairs,
        "thesis": _share(judged, lambda r: r.raw_errors_rad["4"]),
        "ours": _share(judged, lambda r: r.verified_errors_rad["epipolar"]),
    }


def long_edges(data_dir: Path, map_name: str, profile: Profile, longest_m: float) -> Row:
    """Long edges between the nodes of a map: by matches alone, as in the thesis, and in the map itself.

    Args:
        data_dir: where the map and the true poses of its nodes are.
        map_name: an explored map of the village.
        profile: its threshold s_edge_min counts raw matches here, verified ones in the map.
        longest_m: further apart than this a pair of nodes is no neighbourhood.
    """
    truth = load_truth(truth_path(data_dir, map_name))
    poses = truth.poses if truth is not None else {}
    pipeline = Pipeline(find_profile("sift"))
    with open_stack(StackChoice(data_dir, "village", lockstep=True)) as stack:
        graph = require_map(stack, map_name)
        reply = stack.bus.ask(MAP, MapRequest(action="read_features"), READ_TIMEOUT_S, map=map_name)
    nodes = {f.node_id: feature_set(f.features) for f in reply.features if f.node_id in poses}
    raw = [
        (a, b)
        for a, b in combinations(sorted(nodes), 2)
        if len(pipeline.matcher.match(nodes[a], [nodes[b]])[0]) > profile.mapping.s_edge_min
    ]
    ours = [(edge.a, edge.b) for edge in graph.edges]
    return {
        "failure": "long edges between look-alike nodes",
        "map": map_name,
        "places": len(nodes),
        "thesis": {"edges": len(raw), "long": sum(_apart_m(poses, e) > longest_m for e in raw)},
        "ours": {"edges": len(ours), "long": sum(_apart_m(poses, e) > longest_m for e in ours)},
    }


def _near(
    space: FreeSpace, centre_m: tuple[float, float], radius_m: float, count: int, rng: np.random.Generator
) -> list[PosePair]:
    found: list[PosePair] = []
    while len(found) < count:
        pair = draw_pair(space, rng, float(rng.uniform(*APART_M)))
        middle = ((pair.current.x_m + pair.target.x_m) / 2, (pair.current.y_m + pair.target.y_m) / 2)
        if math.dist(middle, centre_m) <= radius_m:
            found.append(pair)
    return found


def _share(results: list[PairResult], error: Callable[[PairResult], float | None]) -> Row:
    errors = [e for r in results if (e := error(r)) is not None]
    wrong = sum(e > WRONG_RAD for e in errors)
    return {"answered": len(errors), "wrong": wrong, "wrong_share": rounded(wrong / max(1, len(errors)), 3)}


def _apart_m(poses: dict[int, Pose], ends: tuple[int, int]) -> float:
    a, b = poses[ends[0]], poses[ends[1]]
    return math.hypot(a.x_m - b.x_m, a.y_m - b.y_m)
