"""Where pictures are taken, and what an answer is worth."""

import numpy as np
import pytest

from experiments.localisation.asking import judge, summary
from experiments.localisation.poses import MAPPED_M, UNMAPPED_M, poses_of
from shared.messages.simulation import Pose

NODES = {1: Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0), 2: Pose(x_m=5.0, y_m=0.0, yaw_rad=0.0)}


def draw(rng):
    return (float(rng.uniform(-1.0, 12.0)), 0.0, 0.0)


@pytest.mark.parametrize("mapped", [True, False])
def test_poses_lie_where_they_should(mapped):
    poses = poses_of(draw, NODES.values(), 30, np.random.default_rng(1), mapped=mapped)
    away = [min(abs(node.x_m - pose.x_m) for node in NODES.values()) for pose in poses]
    assert len(poses) == 30
    assert max(away) < MAPPED_M if mapped else min(away) > UNMAPPED_M


def test_a_map_of_everything_leaves_no_such_floor():
    with pytest.raises(ValueError, match="0 of 3 free spots more than"):
        poses_of(lambda _: (0.5, 0.0, 0.0), NODES.values(), 3, np.random.default_rng(1), mapped=False)


def answer(verdict, *places):
    return {"verdict": verdict, "places": [{"nodes": list(nodes)} for nodes in places]}


def test_answers_are_counted_by_what_they_name():
    at = Pose(x_m=0.3, y_m=0.0, yaw_rad=0.0)
    answers = [
        answer("found", (1,)), answer("found", (2,)), answer("ambiguous", (2,), (1,)),
        answer("ambiguous", (2,)), answer("weak", (1,)), answer("not_found"),
    ]  # fmt: skip
    told = summary([judge(one, at, NODES) for one in answers])
    assert (told["single"], told["single_wrong"]) == (2, 1)
    assert (told["list"], told["list_with_the_place"]) == (2, 1)
    assert (told["weak"], told["weak_with_the_place"], told["not_found"]) == (1, 1, 1)
