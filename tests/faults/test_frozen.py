"""A service that hangs while the robot explores: the wheels stand, and no old command is obeyed."""

import signal
import time
from collections.abc import Iterator

import pytest

from experiments.stack import Stack, StackChoice, open_stack
from shared.bus import wait_until
from tests.faults.watching import Watch, exploring

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(300)]

SMALL_PICTURES = {"SIMULATOR_WIDTH_PX": "512", "SIMULATOR_RANGE_RATE_HZ": "20"}
STOP_S = 0.5
SEEN_S = 0.5
"""Deceleration, 20 Hz sampling, and a machine that does other things."""
HUNG_S = 4.0
OLDEST_FRAME_S = 3.0
BACK_S = 40.0


@pytest.fixture(scope="module")
def stack(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stack]:
    """The apartment in real time, with pictures that a busy machine can follow."""
    folder = tmp_path_factory.mktemp("stack")
    choice = StackChoice(folder, "apartment", seed=1, lockstep=False, environment=SMALL_PICTURES)
    with open_stack(choice) as opened:
        yield opened


@pytest.fixture
def watch(stack: Stack) -> Iterator[Watch]:
    """Follows the true speed while the robot explores; it moves already."""
    with exploring(stack, f"m{time.monotonic_ns()}", BACK_S) as watching:
        yield watching


def frozen_for(stack, service, during_s=HUNG_S):
    """Stop a process for a while; when that was."""
    at_s = time.monotonic()
    stack.launcher.kill(service, signal.SIGSTOP)
    time.sleep(during_s)
    stack.launcher.kill(service, signal.SIGCONT)
    return at_s, time.monotonic()


@pytest.mark.parametrize("service", ["planner", "features", "simulator", "map-store"])
def test_the_wheels_stand_soon_after_the_last_heading_and_nothing_old_is_obeyed(
    stack, watch, service, record_property
):
    _, ended_s = frozen_for(stack, service)
    again = wait_until(lambda: watch.moving() and watch.speeds[-1][0] > ended_s, BACK_S)
    record_property("ran_on_s", round(watch.ran_on_s(), 3))
    record_property("oldest_frame_s", round(watch.oldest_answer_s(), 3))
    assert watch.ran_on_s() <= STOP_S + SEEN_S
    assert watch.oldest_answer_s() <= OLDEST_FRAME_S
    stack.launcher.wait_healthy(service, BACK_S)
    assert again, f"the robot does not drive again: {watch.silent_s()}"
