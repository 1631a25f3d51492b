"""Places of a map to inspect: nodes far from one another, named."""

import math
from pathlib import Path

from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import require_map
from services.launcher.client.stack import Stack
from services.launcher.evaluation.truth_file import load_truth, truth_path
from shared.messages.maps import MapRequest
from shared.messages.places import Place, PutPlace
from shared.messages.simulation import Pose
from shared.topics import MAP

ASK_TIMEOUT_S = 10.0


def named_places(stack: Stack, data_dir: Path, map_name: str, count: int) -> dict[str, Pose]:
    """Name nodes, each the furthest from those before it, and return their true poses by name.

    Raises:
        ExperimentError: the true poses of the map's nodes are not known, or there are too few.
    """
    truth = load_truth(truth_path(data_dir, map_name))
    nodes = sorted(node.node_id for node in require_map(stack, map_name).nodes)
    if truth is None or not set(nodes) <= truth.poses.keys() or len(nodes) < count:
        raise ExperimentError(
            f"map {map_name!r} needs {count} nodes with true poses: explore it with 'topnav explore' first"
        )
    chosen = nodes[:1]
    while len(chosen) < count:
        chosen.append(max(nodes, key=lambda n: min(_apart_m(truth.poses[n], truth.poses[c]) for c in chosen)))
    names = {f"spot {number}": node for number, node in enumerate(chosen, start=1)}
    operations = tuple(PutPlace(place=Place(name=name, nodes=(node,))) for name, node in names.items())
    wish = MapRequest(action="transact", author="study", operations=operations)
    stack.bus.ask(MAP, wish, ASK_TIMEOUT_S, map=map_name)
    return {name: truth.poses[node] for name, node in names.items()}


def _apart_m(a: Pose, b: Pose) -> float:
    return math.hypot(a.x_m - b.x_m, a.y_m - b.y_m)
