"""The drive process over a real bus: the emergency stop, replaced planners, headings that were held up."""

import time

import pytest

from shared.bus import wait_until
from shared.messages.estop import EStopState
from shared.queries import RefusedError
from tests.integration.drive.conftest import SOON_S


@pytest.fixture(autouse=True)
def _asked_again(monkeypatch):
    """A process that stands still for longer than the lease is absent for a while, and then answers."""
    monkeypatch.setattr("shared.queries.MEETING_S", SOON_S)


def go(neighbours, **changes):
    """What a driving robot and its planner say of each frame."""

    def act():
        neighbours.see(seq := neighbours.frame())
        neighbours.wish(seq, **changes)

    return act


def still(commands):
    return all(command.stands for command in commands)


def several(commands):
    return len(commands) > 1


def test_engaged_every_heading_is_answered_with_still_wheels_until_a_person_clears(start, neighbours):
    start()
    assert neighbours.drives(go(neighbours))
    state = neighbours.estop("engage", who="anna", why="a child")
    assert (state.engaged, state.who, state.why) == (True, "anna", "a child")
    answers = neighbours.commands(0.6, go(neighbours, epoch=7), several)
    assert answers[1:]
    assert still(answers[1:])  # the first may have been under way
    assert answers[-1].why == "emergency stop"
    with pytest.raises(RefusedError, match="name of the person"):
        neighbours.estop("clear", who=" ")
    assert neighbours.estop("status") == state
    assert not neighbours.estop("clear", who="anna").engaged
    assert neighbours.drives(go(neighbours, epoch=7))


def test_in_lockstep_a_frame_that_was_answered_with_motion_is_answered_with_still_wheels(start, neighbours):
    start()
    stamp_ns = time.time_ns()

    def ask():
        neighbours.see(3, stamp_ns=stamp_ns, lockstep=True)
        neighbours.wish(3, stamp_ns=stamp_ns)

    assert neighbours.drives(ask)
    neighbours.estop("engage")
    answers = neighbours.commands(0.5, ask, several)[1:]
    assert answers
    assert still(answers)


def test_kill_9_does_not_clear_it(start, neighbours):
    process = start()
    neighbours.estop("engage", who="anna")
    process.kill()
    process.wait()
    start()
    assert neighbours.estop("status").who == "anna"
    answers = neighbours.commands(0.6, go(neighbours), bool)
    assert answers
    assert still(answers)


def test_a_file_that_cannot_be_read_is_an_engaged_stop(start, neighbours, tmp_path):
    (tmp_path / "state").mkdir()
    (tmp_path / "state/estop-r1.json").write_bytes(b"\x00\x00")
    start()
    assert neighbours.estop("status").engaged
    assert not neighbours.estop("clear", who="anna").engaged


def test_the_state_is_told_on_change_and_again_and_again(start, neighbours):
    start()
    assert wait_until(lambda: (s := neighbours.estop_states.take()) is not None and not s.engaged, SOON_S)
    neighbours.estop("engage", why="x")
    for _ in range(2):
        assert wait_until(lambda: (s := neighbours.estop_states.take()) is not None and s.engaged, SOON_S)


def test_a_stop_that_only_the_robot_remembers_is_taken_over(start, neighbours):
    start()
    neighbours.robot_estop.put(EStopState(robot="r1", seq=4, engaged=True, who="anna"))

    def taken_over():
        neighbours.robot_estop.put(EStopState(robot="r1", seq=4, engaged=True, who="anna"))
        return neighbours.estop("status").engaged

    assert wait_until(taken_over, SOON_S)
    assert neighbours.estop("clear", who="bert").seq == 5


def test_of_two_planners_the_lower_epoch_is_refused(start, neighbours):
    start()
    assert neighbours.drives(go(neighbours, epoch=5, heading_rad=0.5))

    older = go(neighbours, epoch=4, heading_rad=-0.5)
    answers = neighbours.commands(1.2, older, lambda _: still([neighbours.newest]))
    assert still([c for c in answers if c.epoch == 4])
    assert not any(command.left_mps < 0.0 for command in answers)
    assert still([neighbours.newest])  # the newer planner's heading expired meanwhile
    assert neighbours.drives(go(neighbours, epoch=6))


def test_a_heading_that_was_held_up_longer_than_it_lives_moves_nothing(start, neighbours):
    start()
    old = neighbours.frame()
    assert neighbours.drives(go(neighbours))  # by now drive knows of a frame as old as that, or newer

    def see():
        neighbours.see(neighbours.frame())

    neighbours.commands(3.0, see, lambda _: still([neighbours.newest]))  # 2 s to decide, 0.5 s to live
    answers = neighbours.commands(0.6, lambda: (see(), neighbours.wish(old)))
    assert still(answers)
    assert neighbours.drives(go(neighbours))
