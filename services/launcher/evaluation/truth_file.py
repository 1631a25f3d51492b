"""Where the nodes of a map truly are: kept beside the maps, read by evaluations and drawings only."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from services.launcher.client.failure import ExperimentError
from services.launcher.client.trail import Trail
from services.launcher.terminal.output import write_json
from shared.messages.maps import Node
from shared.messages.simulation import Pose


@dataclass(frozen=True)
class MapTruth:
    """True pose of each node of a map, by id."""

    world: str
    poses: dict[int, Pose]
    stamps_ns: dict[int, int]


def truth_path(data_dir: Path, map_name: str) -> Path:
    """The file of a map."""
    return data_dir / f"{map_name}.truth.json"


def join_truth(world: str, nodes: Iterable[Node], trail: Trail, before: MapTruth | None) -> MapTruth:
    """Join nodes to true poses by capture time; those of earlier missions are taken from `before`.

    Raises:
        ExperimentError: a node whose frame was never seen.
    """
    poses: dict[int, Pose] = {}
    stamps: dict[int, int] = {}
    for node in nodes:
        pose = trail.pose_at(node.stamp_ns)
        if pose is None and before is not None and before.stamps_ns.get(node.node_id) == node.stamp_ns:
            pose = before.poses[node.node_id]
        if pose is None:
            raise ExperimentError(
                f"node {node.node_id}: no true pose was recorded for its frame {node.frame_seq}"
            )
        poses[node.node_id], stamps[node.node_id] = pose, node.stamp_ns
    return MapTruth(world, poses, stamps)


def save_truth(path: Path, map_name: str, truth: MapTruth) -> None:
    """Write the file."""
    nodes = {
        str(n): {"x_m": p.x_m, "y_m": p.y_m, "yaw_rad": p.yaw_rad, "stamp_ns": truth.stamps_ns[n]}
        for n, p in truth.poses.items()
    }
    write_json(path, {"note": "for evaluation only", "map": map_name, "world": truth.world, "nodes": nodes})


def load_truth(path: Path) -> MapTruth | None:
    """Read the file; None when there is none."""
    if not path.exists():
        return None
    content = json.loads(path.read_text(encoding="utf-8"))
    nodes = {int(n): values for n, values in content["nodes"].items()}
    poses = {n: Pose(x_m=v["x_m"], y_m=v["y_m"], yaw_rad=v["yaw_rad"]) for n, v in nodes.items()}
    return MapTruth(content["world"], poses, {n: v["stamp_ns"] for n, v in nodes.items()})
