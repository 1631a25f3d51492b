"""The emergency stop pauses a mission, which goes on only after a person cleared the stop."""

import pytest

from shared.bus import Bus, wait_until
from shared.messages.estop import EStopState
from shared.queries import RefusedError
from shared.topics import ESTOP_STATE
from tests.integration.map_store.conftest import START_S
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process
from tests.integration.planner.test_end_of_a_mission import ask
from tests.integration.planner.test_end_of_a_mission import planner as planner

pytestmark = pytest.mark.usefixtures("patient_sessions")


def test_a_mission_that_the_emergency_stop_holds_is_resumed_only_after_it_was_cleared(bus: Bus, planner):
    planner()
    drive = bus.publisher(ESTOP_STATE, robot="r1")

    def stands(engaged: bool) -> EStopState:
        state = EStopState(robot="r1", seq=1 + (not engaged), engaged=engaged, who="anna", why="a child")
        drive.put(state)
        return state

    ask(bus, action="explore", map="flat", seed=3)
    assert wait_until(lambda: stands(True) and ask(bus, action="status").state == "paused", START_S)
    assert ask(bus, action="status").reason == "emergency stop: a child"
    with pytest.raises(
        RefusedError, match="emergency stop: a child holds the robot: clear it first"
    ) as caught:
        ask(bus, action="resume")
    assert caught.value.code == "conflict"

    def resumed() -> bool:
        stands(False)
        try:
            return ask(bus, action="resume").state == "running"
        except RefusedError:
            return False

    assert wait_until(resumed, START_S)
    assert ask(bus, action="status").state == "running", "nothing pauses it again"
