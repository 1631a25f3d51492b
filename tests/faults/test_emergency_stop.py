"""Stopping while the robot explores in real time: the emergency stop, and a drive service that hangs."""

import signal
import time
from collections.abc import Iterator

import pytest

from experiments.stack import Stack, StackChoice, open_stack
from shared.bus import wait_until
from shared.messages import Command, EStopRequest
from shared.queries import RefusedError
from shared.topics import COMMAND, ESTOP, FRAME
from tests.faults.watching import STILL_MPS, Watch, ask, ended, exploring

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(300)]

SLOW_MACHINE = {
    "SIMULATOR_WIDTH_PX": "512",
    "SIMULATOR_FRAME_RATE_HZ": "2",
    "SIMULATOR_RANGE_RATE_HZ": "20",
    "PLANNER_HEADING_TTL_MS": "3000",
}
STOP_S = 0.5
HUNG_STOP_S = 0.6
BACK_S = 20.0
SETTLED_S = 1.0


@pytest.fixture(scope="module")
def stack(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stack]:
    """The apartment in real time, with small pictures for busy machines and headings that live long.

    A robot whose headings expired would stand for that reason, and prove nothing about the stop.
    """
    folder = tmp_path_factory.mktemp("stack")
    choice = StackChoice(folder, "apartment", seed=1, lockstep=False, environment=SLOW_MACHINE)
    with open_stack(choice) as opened:
        yield opened


@pytest.fixture
def watch(stack: Stack) -> Iterator[Watch]:
    """Follows the true speed while the robot explores; it moves already."""
    with exploring(stack, "stop", BACK_S) as watching:
        yield watching


def estop(stack, action, **words):
    return stack.bus.ask(ESTOP, EStopRequest(action=action, **words), 5.0, robot=stack.robot)


def insist(stack, during_s=1.0):
    """Somebody commands full speed, in answer to the newest frame."""
    with stack.session() as own:
        frames, commands = (
            own.bus.subscribe(FRAME, robot=own.robot),
            own.bus.publisher(COMMAND, robot=own.robot),
        )
        frame, until_s = frames.wait(10.0), time.monotonic() + during_s
        while time.monotonic() < until_s:
            frame = frames.take() or frame
            commands.put(
                Command(seq=frame.seq, stamp_ns=frame.stamp_ns, robot=own.robot, wheel_speed_radps=5.0)
            )
            time.sleep(0.05)


def test_engaged_the_wheels_stand_through_every_death_until_a_person_clears(stack, watch, record_property):
    engaged_s = time.monotonic()
    assert estop(stack, "engage", who="anna", why="a child").engaged
    record_property("acknowledged_s", time.monotonic() - engaged_s)
    assert wait_until(lambda: watch.still_after_s(engaged_s) is not None, 5.0)
    still_s = watch.still_after_s(engaged_s)
    record_property("still_s", still_s)
    assert still_s <= STOP_S
    assert wait_until(lambda: ask(stack, action="status").state == "paused", 5.0)
    assert ask(stack, action="status").reason == "emergency stop: a child"
    stands_s = engaged_s + SETTLED_S
    for service in ("planner", "drive", "features", "simulator"):
        pid = stack.launcher.kill(service)
        stack.launcher.wait_healthy(service, BACK_S, other_than=pid)
    insist(stack)
    assert wait_until(lambda: ended(stack), BACK_S)
    ask(stack, action="goto", map="stop", goal_node=0)
    insist(stack)
    with pytest.raises(RefusedError, match="name of the person"):
        estop(stack, "clear")
    assert estop(stack, "status").who == "anna"
    assert watch.fastest_mps(stands_s) < STILL_MPS
    assert wait_until(lambda: ended(stack), BACK_S)
    ask(stack, action="explore", map="after", seed=1)
    assert wait_until(lambda: ask(stack, action="status").state == "paused", 5.0)

    assert not estop(stack, "clear", who="bert").engaged
    cleared_s = time.monotonic()
    time.sleep(SETTLED_S)
    assert watch.fastest_mps(cleared_s) < STILL_MPS, "clearing alone must not set the robot going"
    ask(stack, action="resume")
    assert wait_until(watch.moving, timeout_s=30.0)


def test_while_drive_hangs_the_robot_stops_and_nothing_stale_moves_it_after(stack, watch, record_property):
    hung_s = time.monotonic()
    stack.launcher.kill("drive", signal.SIGSTOP)
    try:
        assert wait_until(lambda: watch.still_after_s(hung_s) is not None, 5.0)
        record_property("still_s", watch.still_after_s(hung_s))
        time.sleep(SETTLED_S)  # the planner goes on wishing: that piles up before drive's door
        assert wait_until(lambda: ended(stack), BACK_S)
    finally:
        stack.launcher.kill("drive", signal.SIGCONT)
    time.sleep(2 * SETTLED_S)
    assert watch.still_after_s(hung_s) <= HUNG_STOP_S
    assert watch.fastest_mps(hung_s + HUNG_STOP_S) < STILL_MPS
