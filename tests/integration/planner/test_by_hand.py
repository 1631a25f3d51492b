"""A person who drives by hand pauses a mission; it goes on when it is resumed."""

import pytest

from shared.bus import Bus, wait_until
from shared.messages.drive import Manual
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
