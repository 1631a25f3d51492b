"""Joining nodes with true poses, and the file they are kept in."""

import pytest

from services.launcher.client.failure import ExperimentError
from services.launcher.client.trail import Trail
from services.launcher.evaluation.truth_file import MapTruth, join_truth, load_truth, save_truth
from shared.messages.maps import Node
from shared.messages.simulation import Pose, Truth

POSE = Pose(x_m=1.0, y_m=2.0, yaw_rad=0.5)


def trail_with(stamp_ns):
    trail = Trail()
    trail.add([Truth(seq=1, stamp_ns=stamp_ns, robot="r1", world="w", pose=POSE)])
    return trail


def test_nodes_get_the_pose_of_their_frame():
    truth = join_truth("w", [Node(node_id=4, stamp_ns=77)], trail_with(77), None)
    assert truth == MapTruth("w", {4: POSE}, {4: 77})


def test_nodes_of_an_earlier_mission_keep_theirs():
    before = MapTruth("w", {0: POSE}, {0: 5})
    truth = join_truth(
        "w", [Node(node_id=0, stamp_ns=5), Node(node_id=1, stamp_ns=77)], trail_with(77), before
    )
    assert truth.poses == {0: POSE, 1: POSE}


def test_a_node_of_another_map_with_the_same_id_is_not_taken_for_it():
    before = MapTruth("w", {0: POSE}, {0: 5})
    with pytest.raises(ExperimentError, match="node 0"):
        join_truth("w", [Node(node_id=0, stamp_ns=6)], trail_with(77), before)


def test_file_round_trip(tmp_path):
    truth, path = MapTruth("w", {3: POSE}, {3: 9}), tmp_path / "flat.truth.json"
    save_truth(path, "flat", truth)
    assert load_truth(path) == truth
    assert load_truth(tmp_path / "other.truth.json") is None
