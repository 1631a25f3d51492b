"""The guard between whoever drives and the base: near things, silence, and a driver that is killed."""

import numpy as np
import pytest

from services.ros.conversions.twist import STAND, Motion, twist_bytes
from services.ros.wires.wire import URGENT
from shared.bus import wait_until
from tests.integration.ros.conftest import SOON_S
from tests.ros_messages import CODEC, TWIST, TWIST_STAMPED

AHEAD = Motion(0.25, 0.0, 0.0)
GUARD = {
    "velocity": {"topic": "/wish", "type": TWIST_STAMPED},
    "guard": {"topic": "/cmd_vel", "type": TWIST, "stop_m": 0.3},
}


@pytest.fixture
def guarded(robot, start, join):
    """A guarded base, and what says a wish once."""
    base, process = robot(TWIST), start("services.ros.guard", **GUARD)
    driver = join("driver")
    say = driver.publisher("/wish", TWIST_STAMPED, URGENT)
    assert wait_until(lambda: driver.subscribers("/wish") != [], SOON_S), process.log

    def wish(motion=AHEAD):
        say(twist_bytes(CODEC, TWIST_STAMPED, motion, "", None))

    return base, wish, process


def driving(wish, reached):
    def step():
        wish()
        return reached()

    return wait_until(step, SOON_S)


def test_a_wish_reaches_the_base_as_the_type_that_it_hears_and_ends_when_nobody_wishes(guarded):
    base, wish, _ = guarded
    assert driving(wish, lambda: base.motion == AHEAD)
    assert base.is_told(STAND)
    stood_s = next(at_s for motion, at_s, _ in reversed(base.heard) if motion == AHEAD)
    first_s = next(at_s for motion, at_s, _ in base.heard if motion == STAND and at_s > stood_s)
    assert first_s - stood_s < 0.5


@pytest.mark.parametrize("choice", ["rmw_zenoh"], indirect=True)
def test_before_a_wall_it_stands_and_says_why(guarded):
    base, wish, process = guarded
    assert driving(wish, lambda: base.motion == AHEAD)
    base.ranges_m = np.full(360, 0.29)
    assert driving(wish, lambda: base.motion == STAND)
    assert process.says("0.00 m are free")


@pytest.mark.parametrize("choice", ["rmw_zenoh"], indirect=True)
def test_without_scans_it_stands_though_it_is_told_to_go(guarded):
    base, wish, process = guarded
    assert driving(wish, lambda: base.motion == AHEAD)
    base.senses = False
    assert driving(wish, lambda: base.motion == STAND)
    assert process.says("no scan for")


@pytest.mark.parametrize("choice", ["rmw_zenoh"], indirect=True)
def test_a_file_without_a_guard_ends_it_with_one_line(start):
    process = start("services.ros.guard")
    assert process.popen.wait(SOON_S) == 1
    assert "a section 'guard' expected" in process.log
