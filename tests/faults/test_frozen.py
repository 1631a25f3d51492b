"""A service that hangs while the robot explores: the wheels stand, and no old command is obeyed."""

import signal
import time
from collections.abc import Iterator

import pytest

from experiments.hand import Hand
from experiments.stack import Stack, StackChoice, open_stack
from shared.bus import wait_until
from shared.messages import MissionRequest
from shared.queries import QueryError
from shared.topics import MISSION
from tests.faults.watching import Watch

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
    Hand(stack.bus, stack.robot).reset(1)
    ask(stack, action="explore", map=f"m{time.monotonic_ns()}", seed=1)
    with Watch(stack.endpoint, stack.robot) as watching:
        assert wait_until(watching.moving, timeout_s=30.0)
        yield watching
    assert wait_until(lambda: cancelled(stack), BACK_S, 0.2)


def ask(stack, **request):
    return stack.bus.ask(MISSION, MissionRequest(**request), 10.0, robot=stack.robot)


def cancelled(stack):
    """End the mission; a planner that hung has to be asked again."""
    try:
        if ask(stack, action="status").state in ("running", "paused"):
            ask(stack, action="cancel")
    except QueryError:
        return False
    return True


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
