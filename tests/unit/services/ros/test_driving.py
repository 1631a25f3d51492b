"""How long a velocity counts, and which are refused."""

from services.ros.conversions.twist import STAND, Motion, MotionLimits
from services.ros.driving import Driving
from shared.messages.drive import Velocity

HOLONOMIC = MotionLimits(0.5, 0.5, 1.0)


def velocity(seq=1, **fields):
    return Velocity(seq=seq, robot="r1", **{"forward_mps": 0.25, "ttl_ms": 500, **fields})


def driving(limits=HOLONOMIC):
    found = Driving(limits)
    found.frame_out(1, 10.0)
    return found


def test_a_velocity_counts_until_its_life_is_over():
    found = driving()
    assert found.hear(velocity(), 10.1, 10.1) == ""
    assert found.wanted(10.5, hold=False) == Motion(0.25, 0.0, 0.0)
    assert found.wanted(10.6, hold=False) == STAND


def test_its_life_begins_when_it_came_and_not_when_it_was_read():
    found = driving()
    found.hear(velocity(), 10.0, 10.45)
    assert found.wanted(10.51, hold=False) == STAND


def test_nothing_moves_while_it_must_hold_or_after_it_was_forgotten():
    found = driving()
    found.hear(velocity(), 10.1, 10.1)
    assert found.wanted(10.2, hold=True) == STAND
    found.forget()
    assert found.wanted(10.2, hold=False) == STAND


def test_a_velocity_for_a_frame_that_never_went_out_or_is_old_is_refused():
    assert "frame 2, which did not go out" in driving().hear(velocity(2), 10.1, 10.1)
    assert "frame 1" in Driving(HOLONOMIC).hear(velocity(), 10.1, 10.1)
    found = driving()
    found.frame_out(2, 13.5)
    assert "frame 1" in found.hear(velocity(1), 13.6, 13.6)
    assert found.wanted(13.6, hold=False) == STAND


def test_the_base_is_told_no_more_than_it_can():
    found = driving()
    found.hear(velocity(forward_mps=1.0, turn_radps=1.0), 10.1, 10.1)
    assert found.wanted(10.2, hold=False) == Motion(0.5, 0.0, 0.5)


def test_sideways_for_a_base_that_cannot_is_refused_with_what_to_set():
    found = driving(MotionLimits(0.5, 0.0, 1.0))
    assert "TOPNAV_BASE" in found.hear(velocity(left_mps=0.1), 10.1, 10.1)
    assert found.wanted(10.2, hold=False) == STAND
