"""What a robot's moves look like to its camera says what is wrong with it."""

import math

import numpy as np
import pytest

from services.launcher.checking.motion import MOVES, Seen, below_above, falls_short, motion_problems
from shared.messages.matching import NodeMatch


def match(heading_rad=None, yaw_rad=0.0, status="ok", confidence=0.9, **more):
    return NodeMatch(
        node_id=-1, raw_matches=90, inliers=80, status=status, heading_rad=heading_rad, yaw_rad=yaw_rad,
        confidence=confidence if heading_rad is not None else 0.0, **more,
    )  # fmt: skip


def wrapped(angle_rad):
    return math.remainder(angle_rad, math.tau)


def seen(move, direction=lambda rad: rad, turn=lambda rad: rad, share=1.0, odometry=None):
    """A move as a camera sees it whose directions and turns are changed so."""
    if move.turn_rad:
        found = match(yaw_rad=turn(share * move.turn_rad), status="no_baseline")
    else:
        found = match(wrapped(direction(move.direction_rad)))
    return Seen(move, share, found, odometry)


def all_seen(moves=MOVES, **changes):
    return [seen(move, **changes) for move in moves]


DIFFERENTIAL = [move for move in MOVES if not move.left_m]


def test_a_robot_that_does_as_it_is_told_has_no_problem():
    assert motion_problems(all_seen()) == []
    assert motion_problems(all_seen(DIFFERENTIAL)) == []


@pytest.mark.parametrize("moves", [MOVES, DIFFERENTIAL], ids=["holonomic", "differential"])
@pytest.mark.parametrize(
    ("turned_deg", "named"), [(90, "90 degrees to the right"), (-20, "20 degrees to the left")]
)
def test_a_camera_that_looks_elsewhere_is_named_with_the_angle_to_set(moves, turned_deg, named):
    problems = motion_problems(all_seen(moves, direction=lambda rad: rad + math.radians(turned_deg)))
    assert len(problems) == 1
    assert named in problems[0]
    assert f"add {-turned_deg:+d} to CAMERA_HEADING_DEG" in problems[0]


@pytest.mark.parametrize("moves", [MOVES, DIFFERENTIAL], ids=["holonomic", "differential"])
def test_a_picture_with_left_and_right_swapped_is_named(moves):
    problems = motion_problems(all_seen(moves, direction=lambda rad: -rad, turn=lambda rad: -rad))
    assert "left and right are swapped" in problems[0]


def test_a_sideways_axis_that_is_reversed_is_not_taken_for_a_mirror():
    problems = motion_problems(all_seen(direction=lambda rad: -rad))
    assert problems == [
        "told to go left it goes right, and the other way round: the base's sideways axis is reversed"
    ]


def test_one_direction_that_is_wrong_is_named_alone():
    moved = [seen(move, direction=lambda rad: rad + (1.0 if abs(rad) < 0.1 else 0.0)) for move in MOVES]
    problems = motion_problems(moved)
    assert len(problems) == 1
    assert problems[0].startswith("told to go ahead (0 degrees), the camera sees 57")


def test_wheels_that_turn_the_wrong_way_or_too_far_are_named():
    assert "wired the wrong way round" in motion_problems(all_seen(turn=lambda rad: -rad))[-1]
    problems = motion_problems(all_seen(turn=lambda rad: 1.6 * rad))
    assert [one.partition(",")[0] for one in problems] == [
        "told to turn left by 30 degrees",
        "told to turn right by 30 degrees",
    ]


def test_a_robot_that_stays_where_it_is_is_named_and_a_move_that_drive_refused_is_not():
    still = Seen(MOVES[0], 1.0, match(status="no_baseline"))
    assert "the camera sees no motion" in motion_problems([still])[0]
    assert motion_problems([Seen(MOVES[0], 0.1, match(status="no_baseline"))]) == []


def test_what_cannot_be_told_is_no_problem():
    assert motion_problems([Seen(MOVES[0], 1.0, match(2.0, confidence=0.1))]) == []


@pytest.mark.parametrize(
    ("move", "odometry", "named"),
    [
        (MOVES[0], (0.2, 0.0, 0.0), ""),
        (MOVES[0], (0.4, 0.0, 0.0), "odometry says +0.40 m ahead"),
        (MOVES[2], (0.0, -0.2, 0.0), "odometry says +0.00 m ahead and -0.20 m to the left"),
        (MOVES[4], (0.0, 0.0, -0.5), "odometry says -29 (left is positive)"),
    ],
)
def test_odometry_that_says_otherwise_is_quoted(move, odometry, named):
    problems = motion_problems([seen(move, odometry=odometry)])
    assert named in "".join(problems)
    assert bool(problems) == bool(named)


def test_what_is_below_the_horizon_moves_more_unless_the_camera_hangs_upside_down(rng):
    lon = rng.uniform(-3.0, 3.0, 60)
    before = np.stack([lon, np.where(np.arange(60) % 2, -0.4, 0.4)], axis=1)
    after = before + np.where(before[:, 1:] < 0.0, [[0.1, 0.0]], [[0.02, 0.0]])
    rows = np.hstack([before, after]).astype(np.float32)
    mask = np.ones(60, np.uint8)
    level = match(0.0, matches_rad=rows, inlier_mask=mask)
    assert below_above(level) == pytest.approx(5.0, rel=0.05)
    over = rows * [[1.0, -1.0, 1.0, -1.0]]
    hanging = match(0.0, matches_rad=over.astype(np.float32), inlier_mask=mask)
    assert below_above(hanging) == pytest.approx(0.2, rel=0.05)
    swapped = [
        Seen(move, 1.0, hanging.model_copy(update={"heading_rad": wrapped(-move.direction_rad)}))
        for move in MOVES[:4]
    ]
    turns = [seen(move, turn=lambda rad: -rad) for move in MOVES[4:]]
    assert motion_problems([*swapped, *turns])[0].startswith("the camera hangs upside down")


@pytest.mark.parametrize(
    ("move", "share", "odometry", "short"),
    [
        (MOVES[3], 1.0, (0.0, -0.07, 0.0), True),  # a pause of the machine
        (MOVES[3], 1.0, (0.0, -0.19, 0.0), False),
        (MOVES[3], 0.6, (0.0, -0.11, 0.0), False),  # drive kept it from a wall
        (MOVES[3], 0.3, (0.0, 0.0, 0.0), False),
        (MOVES[3], 1.0, (0.0, 0.19, 0.0), False),  # the wrong way is no interruption
        (MOVES[1], 1.0, (-0.05, 0.0, 0.0), True),
        (MOVES[5], 1.0, (0.0, 0.0, -math.radians(12.0)), True),
        (MOVES[5], 1.0, (0.0, 0.0, math.radians(12.0)), False),
        (MOVES[0], 1.0, None, False),
    ],
)
def test_a_move_that_went_the_right_way_and_not_far_enough_falls_short(move, share, odometry, short):
    assert falls_short(seen(move, share=share, odometry=odometry)) is short
