"""A person who drives by hand pauses a mission; it goes on when it is resumed."""

import pytest

from shared.bus import Bus, wait_until
from shared.messages.drive import Manual
from shared.queries import RefusedError
from shared.topics import MANUAL
from tests.integration.map_store.conftest import START_S
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process
from tests.integration.planner.test_end_of_a_mission import ask
from tests.integration.planner.test_end_of_a_mission import planner as planner

pytestmark = pytest.mark.usefixtures("patient_sessions")


def test_a_mission_pauses_while_a_person_drives_and_is_resumed_by_whoever_wants_it_to_go_on(
    bus: Bus, planner
):
    planner()
    hand = bus.publisher(MANUAL, robot="r1")

    def drives(action: str = "drive") -> bool:
        hand.put(Manual(robot="r1", who="anna", action=action))
        return True

    ask(bus, action="explore", map="flat", seed=3)
    assert wait_until(lambda: drives() and ask(bus, action="status").state == "paused", START_S)
    assert ask(bus, action="status").reason == "anna drives by hand"
    drives("release")
    assert ask(bus, action="status").state == "paused"
    assert ask(bus, action="resume").state == "running"


def test_a_mission_that_goes_along_with_a_hand_is_not_paused_and_ends_when_it_is_finished(bus: Bus, planner):
    planner()
    hand = bus.publisher(MANUAL, robot="r1")
    hand.put(Manual(robot="r1", who="anna"))
    ask(bus, action="teach", map="flat")
    for _ in range(20):
        hand.put(Manual(robot="r1", who="anna"))
        assert ask(bus, action="status").state == "running"
    ended = ask(bus, action="finish")
    assert (ended.state, ended.action) == ("succeeded", "teach")
    assert ended.reason.startswith("taught: the map has 0 nodes")
    ask(bus, action="explore", map="flat")
    with pytest.raises(RefusedError, match="explore ends by itself; cancel it"):
        ask(bus, action="finish")
