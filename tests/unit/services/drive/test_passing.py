"""Passing obstacles: free ways are taken, borders are followed on one side, dead ends are left."""

import itertools
import math

import numpy as np
import pytest

from services.drive.passing import Passing, PassingLimits, Wish, obstacle_heading, steer_away, steer_past
from shared.geometry.clearance import Obstacles

LIMITS = PassingLimits()


def wall(x_m, y_from_m, y_to_m):
    ys = np.arange(y_from_m, y_to_m, 0.05)
    return np.stack([np.full(len(ys), x_m), ys], axis=-1)


def drive(walls, start, goal, steps):
    """Follow the true bearing to the goal past points; the path driven."""
    points = np.concatenate(walls)
    position, memory, path = np.array(start, float), Passing(), [tuple(start)]
    for _ in range(steps):
        to_goal = np.array(goal) - position
        if np.hypot(*to_goal) < 0.15:
            break
        near = points - position
        seen = Obstacles(near[np.hypot(near[:, 0], near[:, 1]) < 4.0])
        steering, memory = steer_past(Wish(math.atan2(to_goal[1], to_goal[0])), seen, memory, LIMITS)
        if not steering.blocked:
            position = position + 0.1 * np.array(
                [math.cos(steering.heading_rad), math.sin(steering.heading_rad)]
            )
        assert np.hypot(*(points - position).T).min() > 0.2, "touched the wall"
        path.append(tuple(position))
    return path


def test_nothing_in_the_way_keeps_the_wished_heading():
    steering, _ = steer_past(Wish(0.7), Obstacles(np.zeros((0, 2))), Passing(), LIMITS)
    assert steering.heading_rad == 0.7
    assert not steering.avoiding


def test_a_wall_ahead_is_passed_and_the_goal_reached():
    path = drive([wall(1.0, -0.6, 0.9)], start=(0.0, 0.0), goal=(2.5, 0.0), steps=120)
    assert math.dist(path[-1], (2.5, 0.0)) < 0.15
    driven_m = sum(math.dist(a, b) for a, b in itertools.pairwise(path))
    assert driven_m < 2.0 * 2.5, "no wandering"


def test_an_end_in_sight_is_preferred():
    path = drive([wall(0.6, -0.15, 3.0)], start=(0.0, 0.0), goal=(2.5, 0.0), steps=60)
    assert math.dist(path[-1], (2.5, 0.0)) < 0.15
    assert min(y for _, y in path) < -0.2


def test_a_remembered_side_yields_to_a_far_easier_one():
    along = np.arange(-2.0, 0.5, 0.05)
    corner = [wall(0.5, -0.1, 0.5), np.stack([along, np.full(len(along), 0.45)], axis=-1)]
    seen = Obstacles(np.concatenate(corner))
    _, memory = steer_past(Wish(0.0), seen, Passing(side=1), LIMITS)
    assert memory.side == -1


def test_a_dead_end_is_left_without_help():
    pocket = [wall(1.0, -0.8, 0.8), wall(0.0, 0.8, 0.81)]
    sides = np.arange(0.2, 1.0, 0.05)
    pocket += [np.stack([sides, np.full(len(sides), y)], axis=-1) for y in (-0.8, 0.8)]
    path = drive(pocket, start=(0.4, 0.0), goal=(2.5, 0.2), steps=600)
    assert math.dist(path[-1], (2.5, 0.2)) < 0.15


def beams(points):
    """What twelve sensors with beams of 30 degrees read of points around."""
    bearings, apart_m = np.arctan2(points[:, 1], points[:, 0]), np.hypot(*points.T)
    axes = np.arange(12) * math.tau / 12
    within = np.abs(np.angle(np.exp(1j * (bearings - axes[:, None])))) <= math.radians(15.0)
    return Obstacles.from_ranges(axes, np.where(within, apart_m, 4.0).min(axis=1), 4.0)


def across(gap_m, width_m, left_m):
    """A corridor that a thin wall crosses, with a gap `left_m` from the right."""
    along = np.arange(-1.0, 6.0, 0.03)
    sides = [np.stack([along, np.full(len(along), y)], axis=-1) for y in (0.0, width_m)]
    pieces = [wall(x_m, *ends) for x_m in (2.9, 2.95) for ends in ((0.0, left_m), (left_m + gap_m, width_m))]
    return np.concatenate([*sides, *pieces, wall(-1.0, 0.0, width_m)])


def stepped(points, at, memory, aim_rad, fraction, told_m=math.inf):
    """Where a robot is one step later, that sees the points by its twelve sensors."""
    steering, memory = steer_past(Wish(aim_rad, fraction, told_m), beams(points - at), memory, LIMITS)
    step_m = 0.12 * min(fraction, steering.speed_fraction)
    at = at + step_m * np.array([math.cos(steering.heading_rad), math.sin(steering.heading_rad)])
    assert np.hypot(*(points - at).T).min() > 0.26, "touched something"
    return at, memory, steering


def steps_through(points, y_m, goal_y_m, speed_fraction):
    """Steps of a robot that drives past `across`, as it sees it; None where it does not get through."""
    at, goal, memory = np.array([0.5, y_m]), np.array([4.5, goal_y_m]), Passing()
    for step in range(200):
        left = goal - at
        if np.hypot(*left) < 0.3:
            return step
        at, memory, _ = stepped(points, at, memory, math.atan2(left[1], left[0]), speed_fraction)
    return None


@pytest.mark.parametrize("speed_fraction", [0.5, 1.0])
@pytest.mark.parametrize("gap_m", [0.7, 0.75, 0.82, 0.9])
@pytest.mark.parametrize("y_m", [0.5, 0.8, 1.0, 1.3, 1.6])
def test_a_gap_little_wider_than_the_robot_is_driven_through_beside_an_open_leaf(y_m, gap_m, speed_fraction):
    """A robot that only meets it must step aside, and come through slowly."""
    assert steps_through(across(gap_m, 2.0, 2.0 - gap_m), y_m, 1.0, speed_fraction)


@pytest.mark.parametrize("speed_fraction", [0.5, 1.0])
@pytest.mark.parametrize("gap_m", [0.66, 0.7, 0.75, 0.82, 0.9])
@pytest.mark.parametrize("y_m", [0.5, 1.0, 1.5, 2.0, 2.5])
def test_so_is_a_narrow_doorway_in_the_middle_of_a_wall(y_m, gap_m, speed_fraction):
    assert steps_through(across(gap_m, 3.0, 1.5 - gap_m / 2), y_m, 1.5, speed_fraction)


@pytest.mark.parametrize("room_m", [0.285, 0.305, 0.33, 0.4])
@pytest.mark.parametrize("seed", range(8))
def test_a_spot_close_to_a_wall_is_come_to_by_headings_that_are_a_little_off(seed, room_m):
    rng, points = np.random.default_rng(seed), wall(room_m, -3.0, 3.0)
    start_rad = rng.uniform(0.6 * math.pi, 1.4 * math.pi)
    at, memory, error_rad = 1.5 * np.array([math.cos(start_rad), math.sin(start_rad)]), Passing(), 0.0
    for _ in range(60):
        left_m = float(np.hypot(*at))
        if left_m < 0.03:
            return
        error_rad = 0.7 * error_rad + rng.normal(0.0, 0.25)
        wished_rad, told_m = math.atan2(-at[1], -at[0]) + error_rad, left_m * rng.uniform(0.8, 1.8)
        fraction = min(1.0, max(0.15, told_m / 1.33))
        at, memory, _ = stepped(points, at, memory, wished_rad, fraction, told_m)
    raise AssertionError(f"{left_m:.2f} m away")


def test_round_a_long_wall_it_is_slow_only_at_first():
    points = np.concatenate([wall(1.0, -2.0, 2.0), wall(1.6, -2.0, 2.0)])
    at, memory, slow = np.array([0.0, 0.0]), Passing(), 0
    for _ in range(180):
        left = np.array([3.0, 0.0]) - at
        if np.hypot(*left) < 0.3:
            break
        left_rad, left_m = math.atan2(left[1], left[0]), float(np.hypot(*left))
        at, memory, steering = stepped(points, at, memory, left_rad, 1.0, left_m)
        slow += steering.speed_fraction < 1.0
    assert np.hypot(*left) < 0.3
    assert slow < 120


def test_what_leads_past_nearly_straight_on_is_passed_at_the_speed_asked_for():
    steering, _ = steer_past(Wish(0.0), Obstacles(wall(0.7, -0.5, 0.1)), Passing(), LIMITS)
    assert (steering.avoiding, steering.speed_fraction) == (True, 1.0)


def test_the_side_is_kept_while_the_border_lasts():
    memory = Passing()
    sides = set()
    for y in np.arange(0.0, 0.5, 0.05):
        seen = Obstacles(wall(0.6, -1.2 - y, 1.0 - y))
        _, memory = steer_past(Wish(0.0), seen, memory, LIMITS)
        sides.add(memory.side)
    assert sides == {1}


def test_a_side_that_does_not_lead_past_is_given_up_for_the_other():
    seen = Obstacles(wall(0.4, -50.0, 50.0))
    memory, changes = Passing(), []
    for step in range(100):
        before = memory.side
        _, memory = steer_past(Wish(0.0), seen, memory, LIMITS)
        if before and memory.side != before:
            changes.append(step)
    assert len(changes) == 2
    assert changes[1] - changes[0] == pytest.approx(2 * changes[0], abs=3), "patience doubles"


def test_enclosed_robot_stands_still():
    around = np.arange(-math.pi, math.pi, 0.05)
    ring = Obstacles(0.32 * np.stack([np.cos(around), np.sin(around)], axis=-1))
    steering, _ = steer_past(Wish(0.0), ring, Passing(), LIMITS)
    assert steering.blocked


ANGLES = tuple(math.remainder(i * math.tau / 12, math.tau) for i in range(12))


def distances(**near):
    readings = [4.0] * 12
    for sector, value in near.items():
        readings[int(sector[1:])] = value
    return tuple(readings)


def test_obstacle_heading_is_the_near_sensor():
    assert obstacle_heading(ANGLES, distances(s3=0.4), 0.5) == pytest.approx(math.pi / 2)


def test_two_near_sensors_give_the_direction_between():
    assert obstacle_heading(ANGLES, distances(s0=0.4, s1=0.4), 0.5) == pytest.approx(math.radians(15.0))


def test_nothing_near_is_no_obstacle():
    assert obstacle_heading(ANGLES, distances(), 0.5) is None
    assert steer_away(0.3, None, np.random.default_rng(0)).heading_rad == 0.3


def test_blend_leans_away_and_keeps_part_of_the_estimate():
    rng = np.random.default_rng(1)
    for _ in range(200):
        steering = steer_away(math.pi / 2, 0.0, rng)
        assert steering.avoiding
        assert math.pi / 2 < steering.heading_rad < math.pi, "between the estimate and straight away"
        assert steering.heading_rad > math.radians(135.0) - 1e-9, "w1 is above one half"
