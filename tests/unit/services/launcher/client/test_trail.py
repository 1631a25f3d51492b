"""The true way: repeated frames, lengths, moves by hand, poses by capture time."""

import math

import pytest

from services.launcher.client.trail import Trail, collisions, driven_m, manual_moves, spl
from shared.messages.simulation import Pose, Truth

SECOND_NS = 1_000_000_000


def truth(seq, x_m, hits=0, yaw_rad=0.0, step_s=0.3):
    pose = Pose(x_m=x_m, y_m=0.0, yaw_rad=yaw_rad)
    stamp_ns = int(seq * step_s * SECOND_NS)
    return Truth(
        seq=seq, stamp_ns=stamp_ns, robot="r1", world="w", pose=pose, sim_time_s=seq * step_s, collisions=hits
    )


def test_a_repeated_frame_is_kept_once():
    trail = Trail()
    trail.add([truth(1, 0.0), truth(1, 0.0), truth(2, 0.1)])
    assert [t.seq for t in trail.truths] == [1, 2]


def test_since_begins_with_the_state_before_the_mark():
    trail = Trail()
    trail.add([truth(1, 0.0), truth(2, 0.1)])
    mark = trail.mark()
    trail.add([truth(3, 0.3)])
    assert [t.seq for t in trail.since(mark)] == [2, 3]
    assert driven_m(trail.since(mark)) == pytest.approx(0.2)


def test_the_way_is_the_sum_of_its_steps():
    assert driven_m([truth(1, 0.0), truth(2, 0.2), truth(3, 0.1)]) == pytest.approx(0.3)


def test_collisions_are_counted_over_a_counter_that_restarts():
    assert collisions([truth(1, 0, 3), truth(2, 0, 4), truth(3, 0, 0), truth(4, 0, 2)]) == 3


def test_only_a_step_too_long_to_drive_is_a_move_by_hand():
    assert manual_moves([truth(1, 0.0), truth(2, 0.6), truth(3, 2.6)]) == 1


def test_pose_of_a_frame_is_exact_and_in_between_it_is_interpolated():
    trail = Trail()
    trail.add([truth(1, 0.0, yaw_rad=3.0), truth(2, 0.2, yaw_rad=-3.0)])
    assert trail.pose_at(int(0.3 * SECOND_NS)).x_m == 0.0
    between = trail.pose_at(int(0.45 * SECOND_NS))
    assert between.x_m == pytest.approx(0.1)
    assert abs(between.yaw_rad) == pytest.approx(math.pi)  # the short way round


def test_a_capture_time_outside_the_trail_or_in_a_gap_has_no_pose():
    trail = Trail()
    trail.add([truth(1, 0.0), truth(9, 0.2)])
    for stamp_s in (0.1, 1.0, 3.0):
        assert trail.pose_at(int(stamp_s * SECOND_NS)) is None


@pytest.mark.parametrize(
    ("success", "shortest_m", "driven_m", "expected"),
    [(True, 2.0, 4.0, 0.5), (True, 2.0, 2.0, 1.0), (True, 2.0, 1.8, 1.0), (False, 2.0, 2.0, 0.0)],
)
def test_spl_of_one_round(success, shortest_m, driven_m, expected):
    assert spl(success, shortest_m, driven_m) == expected


def test_a_shortest_way_of_no_length_is_an_error():
    with pytest.raises(ValueError, match="shortest_m must be positive, got 0"):
        spl(True, 0.0, 1.0)
