"""How a robot stands by what its services say."""

import pytest

from services.fleet.condition import Condition, condition_of
from shared.messages.missions import MissionStatus
from shared.messages.tasks import QueueStatus
from shared.robots.seen import Seen

TOLD = QueueStatus(robot="r1")


def seen(state: str = "idle", stopped: bool | None = False, **fields) -> Seen:
    return Seen(MissionStatus(robot="r1", state=state, mission_id="m"), stopped, **fields)


@pytest.mark.parametrize(
    ("robot", "told", "expected"),
    [
        (seen(), TOLD, Condition("ready")),
        (seen("succeeded", charge=0.3), TOLD, Condition("ready")),
        (seen("failed", charge=1.0), TOLD, Condition("ready")),
        (seen(), None, Condition("silent", "nothing is heard of its dispatch")),
        (Seen(None, False), TOLD, Condition("silent", "nothing is heard of its planner")),
        (seen(stopped=None), TOLD, Condition("silent", "nothing is heard of its drive")),
        (seen(), QueueStatus(robot="r1", on_hold=True), Condition("low", "on hold for its battery")),
        (seen(charge=0.29), TOLD, Condition("low", "its battery is at 29%")),
        (seen("running", charge=0.1), TOLD, Condition("low", "its battery is at 10%")),
        (seen(stopped=True), TOLD, Condition("kept", "the emergency stop is engaged")),
        (seen(driver="anna"), TOLD, Condition("kept", "anna drives by hand")),
        (seen("running"), TOLD, Condition("kept", "mission m is running")),
        (seen("paused"), TOLD, Condition("kept", "mission m is paused")),
    ],
)
def test_how_a_robot_stands(robot: Seen, told: QueueStatus | None, expected: Condition):
    assert condition_of(robot, told, battery=0.3) == expected
