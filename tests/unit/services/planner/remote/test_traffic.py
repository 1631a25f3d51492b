"""Asking for the right of way: only where somebody grants it, never going on unheard, and saying it again."""

from typing import Any

import pytest

from services.planner.ports import RightOfWay
from services.planner.remote import traffic
from services.planner.remote.traffic import MISSED_S, RENEWED_S, UNHEARD, Traffic
from shared.messages.traffic import WayReply, WayRequest
from shared.queries import TimedOutError


class Bus:
    """Answers for the fleet service, where one is alive."""

    def __init__(self) -> None:
        self.asked: list[WayRequest] = []
        self.reply: WayReply | None = WayReply(free=1, why="r2 is there", room=(3, 4))
        self.changed: Any = None
        self.counters, self.counted = self, []

    def count(self, kind, _reason):
        self.counted.append(kind)

    def watch_alive(self, changed, _service):
        self.changed = changed

    def ask(self, _query, request, _timeout_s, robot):
        assert robot == request.robot == "r1"
        self.asked.append(request)
        if self.reply is None:
            raise TimedOutError("no answer")
        return self.reply


@pytest.fixture
def clock(monkeypatch):
    """The time of the planner, in seconds; the test sets it."""
    now = [1000.0]
    monkeypatch.setattr(traffic.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture
def bus():
    return Bus()


def test_without_a_fleet_service_all_is_free_and_nobody_is_asked(bus):
    assert Traffic(bus, "r1", 1.0).ask("flat", (1,), (2, 3)) == RightOfWay(2)
    assert bus.asked == []


def test_a_fleet_service_is_asked_with_every_step(bus):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    assert asking.ask("flat", (1,), (2, 3)) == RightOfWay(1, "r2 is there", (3, 4))
    assert bus.asked == [WayRequest(robot="r1", map="flat", at=(1,), ahead=(2, 3), busy=True)]


def test_without_an_answer_the_robot_does_not_go_on(bus):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    bus.reply = None
    assert asking.ask("flat", (1,), (2, 3)) == RightOfWay(0, UNHEARD)
    assert bus.counted == ["no right of way"]


def test_when_the_fleet_service_goes_away_the_robot_waits_before_it_drives_as_if_alone(bus, clock):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    asking.ask("flat", (1,), (2, 3))
    bus.changed("fleet", "a", False)
    clock[0] += MISSED_S - 0.1
    assert asking.ask("flat", (1,), (2, 3)) == RightOfWay(0, UNHEARD)
    clock[0] += 0.1
    assert asking.ask("flat", (1,), (2, 3)) == RightOfWay(2)


def test_one_of_two_fleet_services_that_goes_leaves_the_other_to_ask(bus):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    bus.changed("fleet", "b", True)
    bus.changed("fleet", "a", False)
    assert asking.ask("flat", (1,), (2, 3)).free == 1


def test_a_claim_is_said_again_once_a_second_and_not_more_often(bus, clock):
    asking = Traffic(bus, "r1", 1.0)
    asking.renew("flat", (1,), busy=False, drives=False)
    bus.changed("fleet", "a", True)
    for _ in range(4):
        asking.renew("flat", (1,), busy=False, drives=False)
        clock[0] += RENEWED_S / 2
    assert [(request.at, request.ahead, request.busy) for request in bus.asked] == [((1,), (), False)] * 2


@pytest.mark.parametrize(
    ("drives", "name", "ahead"),
    [(True, "flat", (2, 3)), (False, "flat", ()), (True, "loft", ())],
)
def test_who_takes_long_for_a_step_keeps_the_way_it_was_granted(bus, clock, drives, name, ahead):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    asking.ask("flat", (1,), (2, 3))
    clock[0] += RENEWED_S
    asking.renew(name, (1,), busy=True, drives=drives)
    assert bus.asked[-1] == WayRequest(robot="r1", map=name, at=(1,), ahead=ahead, busy=True)


def test_what_a_mission_before_wanted_is_not_said_again(bus, clock):
    asking = Traffic(bus, "r1", 1.0)
    bus.changed("fleet", "a", True)
    asking.ask("flat", (1,), (2, 3))
    clock[0] += RENEWED_S
    asking.renew("flat", (1,), busy=False, drives=False)
    clock[0] += RENEWED_S
    asking.renew("flat", (1,), busy=True, drives=True)
    assert [request.ahead for request in bus.asked] == [(2, 3), (), ()]
