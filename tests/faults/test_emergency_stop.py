"""Stopping while the robot explores in real time: the emergency stop, and a drive service that hangs."""

import signal
import time
from collections.abc import Iterator
from contextlib import suppress

import pytest

from services.launcher.client.stack import Stack, StackChoice, open_stack
from shared.bus import wait_until
from shared.messages.drive import Velocity
from shared.messages.estop import EStopRequest
from shared.queries import RefusedError
from shared.topics import ESTOP, FRAME, VELOCITY
from tests.faults.watching import MOVES_S, STILL_MPS, TRIES, Watch, ask, ended, exploring, set_off

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(900),
    pytest.mark.usefixtures("patient_sessions"),
]

SLOW_MACHINE = {
    "SIMULATOR_WIDTH_PX": "512",
    "SIMULATOR_FRAME_RATE_HZ": "2",
    "SIMULATOR_RANGE_RATE_HZ": "20",
    "PLANNER_HEADING_TTL_MS": "3000",
}
STOP_S = 0.5
HUNG_STOP_S = 0.6
BACK_S = 90.0
SOON_S = 30.0
SETTLED_S = 1.0
MAP = "stop"


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
    with exploring(stack, MAP, BACK_S) as watching:
        yield watching


def estop(stack, action, **words):
    return stack.bus.ask(ESTOP, EStopRequest(action=action, **words), SOON_S, robot=stack.robot)


def insist(stack, during_s=1.0):
    """Somebody commands full speed, in answer to the newest frame."""
    with stack.session() as own:
        frames, commands = (
            own.bus.subscribe(FRAME, robot=own.robot),
            own.bus.publisher(VELOCITY, robot=own.robot),
        )
        frame, until_s = frames.wait(SOON_S), time.monotonic() + during_s
        while time.monotonic() < until_s:
            frame = frames.take() or frame
            commands.put(Velocity(seq=frame.seq, stamp_ns=frame.stamp_ns, robot=own.robot, forward_mps=0.4))
            time.sleep(0.05)


def engage(stack, watch):
    """Engage while the robot drives, and see it stand: when that was asked, and when it was acknowledged."""
    asked_s = time.monotonic()
    assert estop(stack, "engage", who="anna", why="a child").engaged
    acknowledged_s = time.monotonic()
    assert wait_until(lambda: watch.still_after_s(asked_s) is not None, SOON_S)
    assert wait_until(lambda: ask(stack, action="status").state == "paused", SOON_S)
    return asked_s, acknowledged_s


def drives_on(stack, watch):
    """Whether the robot goes on when asked to: a planner that has yet to hear of a clearing refuses."""
    began_s = time.monotonic()

    def moves():
        with suppress(RefusedError):
            ask(stack, action="resume")
        return watch.moving(began_s)

    return wait_until(moves, MOVES_S, 0.5)


def test_engaged_the_wheels_stand_through_every_death_until_a_person_clears(stack, watch, record_property):
    for tried in range(TRIES):
        if tried:
            assert not estop(stack, "clear", who="anna").engaged
            assert drives_on(stack, watch)
        asked_s, acknowledged_s = engage(stack, watch)
        still_s = watch.still_after_s(asked_s)
        if still_s <= STOP_S:
            break
    record_property("acknowledged_s", acknowledged_s - asked_s)
    record_property("still_s", still_s)
    assert still_s <= STOP_S
    assert ask(stack, action="status").reason == "emergency stop: a child"
    stands_s = acknowledged_s + SETTLED_S
    for service in ("planner", "drive", "features", "simulator"):
        pid = stack.launcher.kill(service)
        stack.launcher.wait_healthy(service, BACK_S, other_than=pid)
    insist(stack)
    assert wait_until(lambda: ended(stack), BACK_S)
    ask(stack, action="goto", map=MAP, goal_node=0)
    insist(stack)
    with pytest.raises(RefusedError, match="name of the person"):
        estop(stack, "clear")
    assert estop(stack, "status").who == "anna"
    assert watch.fastest_mps(stands_s) < STILL_MPS
    assert wait_until(lambda: ended(stack), BACK_S)
    ask(stack, action="explore", map="after", seed=1)
    assert wait_until(lambda: ask(stack, action="status").state == "paused", SOON_S)

    assert not estop(stack, "clear", who="bert").engaged
    cleared_s = time.monotonic()
    assert wait_until(lambda: watch.watched(cleared_s + SETTLED_S), SOON_S)
    assert watch.fastest_mps(cleared_s) < STILL_MPS, "clearing alone must not set the robot going"
    assert drives_on(stack, watch)


def hang(stack, watch):
    """Stop drive while the robot moves: after what time it stood, and its highest speed from then on."""
    hung_s = time.monotonic()
    stack.launcher.kill("drive", signal.SIGSTOP)
    try:
        assert wait_until(lambda: watch.still_after_s(hung_s) is not None, SOON_S)
        time.sleep(SETTLED_S)  # the planner goes on wishing: that piles up before drive's door
        assert wait_until(lambda: ended(stack), BACK_S)
    finally:
        stack.launcher.kill("drive", signal.SIGCONT)
        woken_s = time.monotonic()
    assert wait_until(lambda: watch.watched(woken_s + 2 * SETTLED_S), SOON_S)
    return watch.still_after_s(hung_s), watch.fastest_mps(hung_s + HUNG_STOP_S)


def test_while_drive_hangs_the_robot_stops_and_nothing_stale_moves_it_after(stack, watch, record_property):
    for tried in range(TRIES):
        if tried:
            set_off(stack, watch, MAP)
        still_s, fastest_mps = hang(stack, watch)
        if still_s <= HUNG_STOP_S and fastest_mps < STILL_MPS:
            break
    record_property("still_s", still_s)
    assert still_s <= HUNG_STOP_S
    assert fastest_mps < STILL_MPS
