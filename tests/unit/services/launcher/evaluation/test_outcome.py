"""When a round counts as a success, and what is told of it."""

import pytest

from services.launcher.client.mission import MissionRun
from services.launcher.evaluation.outcome import Round
from shared.messages.missions import MissionStatus
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose, Truth

START = Pose(x_m=2.6, y_m=1.3, yaw_rad=0.0)


def played(state, final_x_m, way=((0.0, 0), (1.0, 1))):
    truths = [
        Truth(seq=s, stamp_ns=s, robot="r1", world="w", pose=Pose(x_m=x, y_m=0.0, yaw_rad=0.0))
        for x, s in way
    ]
    status = MissionStatus(robot="r1", state=state, step=7, failure="lost" if state == "failed" else "")
    hider = Pose(x_m=1.0, y_m=0.0, yaw_rad=0.0)
    final = Pose(x_m=final_x_m, y_m=0.0, yaw_rad=0.0)
    goal = Frame(robot="r1", encoding="bgr8", width_px=2, height_px=1, data=bytes(6))
    return Round(START, hider, final, goal, MissionRun(status, truths, 2.0), 0.8, 0)


@pytest.mark.parametrize(
    ("state", "final_x_m", "success"),
    [("succeeded", 1.4, True), ("succeeded", 1.6, False), ("failed", 1.0, False)],
)
def test_success_needs_both_the_planner_and_the_truth(state, final_x_m, success):
    assert played(state, final_x_m).success is success


def test_figures_have_the_fixed_keys_and_say_why_it_failed():
    figures = played("failed", 3.0).figures()
    assert {"success", "final_distance_m", "spl", "steps", "collisions", "reason"} <= figures.keys()
    assert figures["spl"] == 0.0
    assert str(figures["reason"]).startswith("lost")
    assert played("succeeded", 3.0).figures()["failure"] == "wrong_place"
    assert played("succeeded", 1.0).spl == pytest.approx(0.8)
