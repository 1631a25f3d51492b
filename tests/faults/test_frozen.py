"""A service that hangs while the robot explores: the wheels stand, and no old command is obeyed."""

import signal
import time
from collections.abc import Iterator

import pytest

from services.launcher.client.stack import Stack, StackChoice, open_stack
from shared.bus import wait_until
from tests.faults.watching import TRIES, Watch, exploring

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(900),
    pytest.mark.usefixtures("patient_sessions"),
]

SMALL_PICTURES = {"SIMULATOR_WIDTH_PX": "512", "SIMULATOR_RANGE_RATE_HZ": "20"}
STOP_S = 0.5
SEEN_S = 0.5
"""Deceleration, 20 Hz sampling, and a machine that does other things."""
HUNG_S = 4.0
OLDEST_FRAME_S = 3.0
BACK_S = 90.0


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
    """Stop a process for a while; when it went on."""
    stack.launcher.kill(service, signal.SIGSTOP)
    time.sleep(during_s)
    stack.launcher.kill(service, signal.SIGCONT)
    return time.monotonic()


def drives_after(watch, since_s):
    """Whether the robot drives again."""
    return wait_until(lambda: watch.moving(since_s), BACK_S)


@pytest.mark.parametrize("service", ["planner", "features", "simulator", "map-store"])
def test_the_wheels_stand_soon_after_the_last_heading_and_nothing_old_is_obeyed(
    stack, watch, service, record_property
):
    since_s = 0.0
    for _ in range(TRIES):
        again = drives_after(watch, frozen_for(stack, service))
        ran_on_s, oldest_frame_s = watch.ran_on_s(since_s), watch.oldest_answer_s(since_s)
        if not again or (ran_on_s <= STOP_S + SEEN_S and oldest_frame_s <= OLDEST_FRAME_S):
            break
        since_s = time.monotonic()
    record_property("ran_on_s", round(ran_on_s, 3))
    record_property("oldest_frame_s", round(oldest_frame_s, 3))
    assert ran_on_s <= STOP_S + SEEN_S
    assert oldest_frame_s <= OLDEST_FRAME_S
    stack.launcher.wait_healthy(service, BACK_S)
    assert again, f"the robot does not drive again: {watch.silent_s()}"
