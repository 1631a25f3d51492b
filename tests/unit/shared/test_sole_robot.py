"""Two processes of one robot's name: whoever runs stays, whatever clocks say; a dead one is forgotten."""

import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from shared.bus import Bus, open_bus, wait_until
from shared.sole_robot import SoleRobot, TakenError

SOON_S = 30.0
NEWCOMERS = (-3600, 0, 3600) * 3
"""How far the clocks of some that start are ahead; random ids alone would refuse all in one of ten runs."""

pytestmark = pytest.mark.usefixtures("patient_sessions")


def refused(robot: SoleRobot) -> bool:
    """Whether another one comes first."""
    try:
        robot.require()
    except TakenError:
        return True
    return False


def test_whoever_starts_gives_way_to_whoever_runs_whatever_its_clock_says(
    here: Bus, there: Bus, monkeypatch: pytest.MonkeyPatch
):
    first, now_ns = SoleRobot(here, "r1"), time.time_ns
    first.claim()
    for ahead_s in NEWCOMERS:
        monkeypatch.setattr(time, "time_ns", lambda ahead_s=ahead_s: now_ns() + ahead_s * 1_000_000_000)
        newcomer = SoleRobot(there, "r1")
        assert wait_until(lambda newcomer=newcomer: refused(newcomer), SOON_S)  # type: ignore[misc]
    newest = newcomer._me
    assert wait_until(lambda: newest in first._others, SOON_S)
    first.require()


def test_whoever_starts_first_listens_for_others(here: Bus, router_endpoint: str):
    SoleRobot(here, "r1").claim()

    def claim(_number: int) -> bool:
        with open_bus(router_endpoint) as bus, pytest.raises(TakenError, match="'r1' is driven by another"):
            SoleRobot(bus, "r1").claim()
        return True

    with ThreadPoolExecutor() as pool:
        assert all(pool.map(claim, range(8)))


def test_of_two_that_start_at_once_one_stays(here: Bus, there: Bus):
    both = SoleRobot(here, "r1"), SoleRobot(there, "r1")
    assert wait_until(lambda: any(map(refused, both)), SOON_S)
    lower = next(robot for robot in both if not refused(robot))
    lower.claim()
    assert [refused(robot) for robot in both] == [robot is not lower for robot in both]


def test_of_two_that_ran_without_having_heard_of_each_other_one_stays(here: Bus, there: Bus):
    both = SoleRobot(here, "r1"), SoleRobot(there, "r1")
    for robot in both:
        robot._say("running")
    assert wait_until(lambda: sum(map(refused, both)) == 1, SOON_S)


def test_a_name_is_free_again_once_its_holder_is_gone(here: Bus, router_endpoint: str):
    with open_bus(router_endpoint) as bus:
        first = SoleRobot(bus, "r1")
        first.claim()
        second = SoleRobot(here, "r1")
        assert wait_until(lambda: refused(second), SOON_S)
    assert wait_until(lambda: not refused(second), SOON_S)
    second.claim()
