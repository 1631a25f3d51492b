"""What the guard lets through: near things, old words, sudden starts."""

import math

import numpy as np
import pytest

from services.ros.conversions.scan import Mount, sectors_of
from services.ros.conversions.twist import STAND, Motion
from services.ros.guard.core import GuardCore, speed_limit_mps
from services.ros.robot_file import Guard
from tests.ros_messages import scan

LIMITS = Guard(topic="/cmd_vel", stop_m=0.3, brake_mps2=1.0, accelerate_mps2=0.5, turn_radps2=3.0)
PERIOD_S = 0.05
AHEAD = Motion(0.5, 0.0, 0.0)


def sees(**at_deg):
    """A scan with hits where told and nothing elsewhere; NaN is no reading."""
    ranges = np.full(360, np.inf)
    for name, range_m in at_deg.items():
        centre = int(name[1:])
        ranges[[(centre + k) % 360 for k in range(-15, 15)]] = range_m
    return sectors_of(scan(ranges), Mount(), 0.1, 4.0)


def driven(core, wish, now_s=0.0, seconds=3.0, sectors=None):
    """What the guard says at last to somebody who says the same all the time."""
    free = sees() if sectors is None else sectors
    steps = round(seconds / PERIOD_S)
    for _ in range(steps):
        core.see(free, now_s)
        core.hear(wish, now_s)
        verdict = core.verdict(now_s)
        now_s += PERIOD_S
    return verdict, now_s - PERIOD_S


@pytest.mark.parametrize("free_m", [0.01, 0.1, 1.0, 3.0])
@pytest.mark.parametrize("delay_s", [0.0, 0.1, 0.5])
@pytest.mark.parametrize("brake_mps2", [0.3, 1.0, 2.0])
def test_delay_and_braking_at_the_limit_take_just_the_free_way(free_m, delay_s, brake_mps2):
    speed_mps = speed_limit_mps(free_m, brake_mps2, delay_s)
    assert speed_mps * delay_s + speed_mps**2 / (2.0 * brake_mps2) == pytest.approx(free_m)


def test_where_nothing_is_free_nothing_moves_and_where_all_is_nothing_is_limited():
    assert speed_limit_mps(0.0, 1.0, 0.1) == speed_limit_mps(-1.0, 1.0, 0.1) == 0.0
    assert speed_limit_mps(math.inf, 1.0, 0.1) == math.inf


def test_in_the_open_a_wish_is_passed_on():
    verdict, _ = driven(GuardCore(LIMITS, PERIOD_S), Motion(0.4, 0.2, -0.5))
    assert verdict.motion == Motion(0.4, 0.2, -0.5)
    assert verdict.why == ""


def test_towards_what_is_near_it_is_slower_on_the_same_curve_and_says_why():
    verdict, _ = driven(GuardCore(LIMITS, PERIOD_S), Motion(0.5, 0.0, 0.25), sectors=sees(_0=0.35))
    assert verdict.motion.forward_mps == pytest.approx(speed_limit_mps(0.05, 1.0, PERIOD_S), rel=0.05)
    assert verdict.motion.turn_radps == pytest.approx(verdict.motion.forward_mps / 2.0)
    assert "m are free" in verdict.why


def test_at_the_stop_distance_only_ways_that_lead_off_are_open():
    near = sees(_0=0.29)
    assert driven(GuardCore(LIMITS, PERIOD_S), AHEAD, sectors=near)[0].motion.stands
    back = Motion(-0.3, 0.0, 0.0)
    assert driven(GuardCore(LIMITS, PERIOD_S), back, sectors=near)[0].motion == back
    turn = Motion(0.0, 0.0, 1.0)
    assert driven(GuardCore(LIMITS, PERIOD_S), turn, sectors=near)[0].motion == turn


def test_sideways_motion_looks_sideways():
    left = Motion(0.0, 0.4, 0.0)
    assert driven(GuardCore(LIMITS, PERIOD_S), left, sectors=sees(_90=0.29))[0].motion.stands
    assert driven(GuardCore(LIMITS, PERIOD_S), left, sectors=sees(_0=0.5))[0].motion == left


def test_where_the_scanner_is_blind_nothing_is_driven():
    behind_unseen = sees(_180=float("nan"))
    assert behind_unseen.blind == (6,)
    assert driven(GuardCore(LIMITS, PERIOD_S), Motion(-0.2, 0.0, 0.0), sectors=behind_unseen)[0].motion.stands
    assert driven(GuardCore(LIMITS, PERIOD_S), AHEAD, sectors=behind_unseen)[0].motion == AHEAD


def test_it_stops_when_commands_age_and_says_so_once():
    core = GuardCore(LIMITS, PERIOD_S)
    _, now_s = driven(core, AHEAD)
    core.see(sees(), now_s + 0.24)
    assert core.verdict(now_s + 0.24).motion == AHEAD
    verdict = core.verdict(now_s + 0.26)
    assert verdict.motion == STAND
    assert verdict.why == "no velocity for 0.26 s"
    assert core.verdict(now_s + 0.31).why == ""


def test_it_stops_when_scans_age_though_commands_come():
    core = GuardCore(LIMITS, PERIOD_S)
    _, now_s = driven(core, AHEAD)
    core.hear(AHEAD, now_s + 0.41)
    verdict = core.verdict(now_s + 0.41)
    assert (verdict.motion, verdict.why) == (STAND, "no scan for 0.41 s")


def test_nothing_moves_before_the_first_scan():
    core = GuardCore(LIMITS, PERIOD_S)
    core.hear(AHEAD, 0.0)
    assert core.verdict(0.0).motion.stands


def test_older_scans_allow_less_speed():
    speeds = []
    for age_s in (0.0, 0.2, 0.35):
        core = GuardCore(LIMITS, PERIOD_S)
        _, now_s = driven(core, AHEAD, sectors=sees(_0=0.6))
        core.hear(AHEAD, now_s + age_s)
        speeds.append(core.verdict(now_s + age_s).motion.forward_mps)
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[0] > speeds[-1]


def test_speeding_up_takes_its_time_and_slowing_down_none():
    core = GuardCore(LIMITS, PERIOD_S)
    said, now_s = [], 0.0
    for _ in range(30):
        core.see(sees(), now_s)
        core.hear(AHEAD, now_s)
        said.append(core.verdict(now_s).motion.forward_mps)
        now_s += PERIOD_S
    gains = np.diff(said)
    assert max(gains) <= LIMITS.accelerate_mps2 * PERIOD_S + 1e-9
    assert said[-1] == 0.5
    core.hear(Motion(0.1, 0.0, 0.0), now_s)
    assert core.verdict(now_s).motion.forward_mps == pytest.approx(0.1)


def test_turning_the_other_way_begins_as_from_rest():
    core = GuardCore(LIMITS, PERIOD_S)
    _, now_s = driven(core, Motion(0.0, 0.0, 1.0))
    core.hear(Motion(0.0, 0.0, -1.0), now_s + PERIOD_S)
    assert core.verdict(now_s + PERIOD_S).motion.turn_radps >= -3.0 * PERIOD_S - 1e-9


def test_driving_back_begins_as_from_rest():
    core = GuardCore(LIMITS, PERIOD_S)
    _, now_s = driven(core, AHEAD)
    core.hear(Motion(-0.5, 0.0, 0.0), now_s + PERIOD_S)
    assert core.verdict(now_s + PERIOD_S).motion.forward_mps >= -0.5 * PERIOD_S - 1e-9
