"""The robot in physics: where it goes, when it stops, what it bumps into, and that it does so again."""

import math

import pytest


def towards(heading_rad, speed_mps):
    return speed_mps * math.cos(heading_rad), speed_mps * math.sin(heading_rad)


def distance_m(a, b):
    return math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)


@pytest.mark.parametrize("heading_deg", [0, 60, -30, 90, 135, 180, -120])
def test_robot_rolls_where_the_wheels_point_without_turning_its_body(simulation, heading_deg):
    before = simulation.truth()
    simulation.command(*towards(math.radians(heading_deg), 0.4))
    simulation.step(1.5)
    after = simulation.truth()
    went = math.atan2(after.y_m - before.y_m, after.x_m - before.x_m)
    assert math.cos(went - math.radians(heading_deg)) > math.cos(math.radians(1.0))
    assert distance_m(before, after) == pytest.approx(1.5 * 0.4, abs=0.12)
    assert abs(after.yaw_rad) < math.radians(0.3)


@pytest.mark.parametrize("heading_deg", [60, -30])
def test_steer_servos_reach_the_commanded_angle(simulation, heading_deg):
    simulation.command(*towards(math.radians(heading_deg), 0.08))
    simulation.step(0.4)
    for angle in simulation.steer_angles_rad():
        assert math.degrees(angle) == pytest.approx(heading_deg, abs=1.0)


def test_standing_robot_does_not_drift(simulation):
    simulation.step(0.5)
    before = simulation.truth()
    simulation.step(5.0)
    assert distance_m(before, simulation.truth()) < 1e-4


def test_wheels_stop_when_the_command_is_too_old(simulation):
    simulation.command(0.4, ttl_s=0.5)
    simulation.step(0.5)
    assert simulation.truth().speed_mps > 0.3
    simulation.step(0.5)
    assert simulation.truth().speed_mps < 0.005


def test_renewed_command_keeps_the_robot_going(simulation):
    for _ in range(5):
        simulation.command(0.4, ttl_s=0.3)
        simulation.step(0.2)
    assert simulation.truth().speed_mps == pytest.approx(0.4, abs=0.02)


def test_same_seed_and_commands_give_bit_identical_poses(simulation):
    def drive():
        simulation.reset(seed=5, pose=(1.0, 1.0, 0.3))
        readings = []
        for k in range(12):
            simulation.command(*towards(0.7 * k, 0.32 + 0.008 * k), ttl_s=0.3)
            simulation.step(0.3)
            readings.append(tuple(simulation.ranges()))
        return simulation.truth(), readings

    assert drive() == drive()


def test_wall_is_hit_once_and_stops_the_robot(simulation):
    simulation.command(-0.48)
    simulation.step(8.0)
    after = simulation.truth()
    assert after.collisions == 1
    assert after.x_m == pytest.approx(simulation.settings.robot.body_radius_m, abs=0.02)


def test_two_separate_bumps_count_twice(simulation):
    for _ in range(2):
        simulation.command(-0.48)
        simulation.step(6.0)
        simulation.command(0.48)
        simulation.step(3.0)
    assert simulation.truth().collisions == 2


def test_table_top_stops_the_mast(simulation):
    simulation.reset(seed=0, pose=(3.5, 3.0, 0.0))
    simulation.command(0.4)
    simulation.step(6.0)
    after = simulation.truth()
    assert after.collisions >= 1
    assert after.x_m < 4.75  # the chassis fits under the table: the top holds the mast, the robot leans back


def test_free_driving_counts_no_collision(simulation):
    simulation.command(0.4)
    simulation.step(3.0)
    assert simulation.truth().collisions == 0


def test_nothing_bumps_into_the_hider(simulation):
    simulation.place_hider(2.6, 2.0, 0.0)
    simulation.command(0.4)
    simulation.step(3.0)
    assert simulation.truth().collisions == 0
    assert simulation.truth().x_m > 2.9


def test_reset_clears_time_and_collisions_and_keeps_the_hider(simulation):
    simulation.place_hider(4.0, 1.0, 0.0)
    simulation.step(1.0)
    simulation.reset(seed=1, pose=(1.0, 1.0, 1.0))
    truth = simulation.truth()
    assert (truth.time_s, truth.collisions, truth.hider) == (0.0, 0, (4.0, 1.0, 0.0))
    assert (truth.x_m, truth.y_m, truth.yaw_rad) == pytest.approx((1.0, 1.0, 1.0))


def test_pictures_without_a_renderer_say_what_to_set(simulation):
    with pytest.raises(RuntimeError, match="render=False"):
        simulation.panorama()


@pytest.mark.parametrize(
    "bad", [(math.nan, 1.0, 0.0), (0.0, math.inf, 0.0), (0.0, 1.0, math.nan), (1.0, 0.0, 0.0, -1.0)]
)
def test_impossible_command_is_refused(simulation, bad):
    with pytest.raises(ValueError, match="command must be finite"):
        simulation.command(*bad)
