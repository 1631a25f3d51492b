"""A robot that rocks: how much, what starts it, that it ends, and that it is the same again."""

import math
from itertools import repeat

import numpy as np
import pytest

from simulator.disturbances.levels import Disturbances
from simulator.disturbances.rocking import RMS_RAD, Rocking, drawn, step
from simulator.settings import SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

DT_S = 0.01
SPEED_MPS = 0.4
AHEAD, STILL = (SPEED_MPS, 0.0), (0.0, 0.0)
NO_EDGE = Rocking(way_m=math.inf)


def towards(heading_rad):
    return SPEED_MPS * math.cos(heading_rad), SPEED_MPS * math.sin(heading_rad)


def driven(state, velocities, seed=1):
    """States after each of a row of velocities."""
    states = []
    for velocity in velocities:
        state = step(state, velocity, DT_S, seed)
        states.append(state)
    return states


def size_rad(state):
    return math.hypot(state.pitch_rad, state.roll_rad)


def test_braking_puts_the_nose_down_and_setting_off_up():
    start, *_, driving = driven(NO_EDGE, repeat(AHEAD, 300))
    stopping = driven(driving, repeat(STILL, 20))
    off = driven(NO_EDGE, repeat(AHEAD, 20))
    assert start.edges == 0
    assert math.degrees(max(s.pitch_rad for s in stopping)) > 1.4
    assert math.degrees(min(s.pitch_rad for s in off)) < -1.4
    assert all(s.roll_rad == 0.0 for s in (*stopping, *off))


def test_a_push_to_the_left_lifts_the_left_side():
    pushed = driven(NO_EDGE, repeat((0.0, SPEED_MPS), 20))
    assert math.degrees(max(s.roll_rad for s in pushed)) > 1.4
    assert all(s.pitch_rad == 0.0 for s in pushed)


def test_edges_lie_where_the_seed_puts_them_whatever_the_speed():
    def edges(speed_mps, steps, seed):
        way_m = 0.0
        found, state = [], Rocking()
        for _ in range(steps):
            before, state = state.edges, step(state, (speed_mps, 0.0), DT_S, seed)
            way_m += speed_mps * DT_S
            found += [way_m] * (state.edges - before)
        return found

    fast, slow = edges(0.4, 1000, seed=2), edges(0.2, 2000, seed=2)
    assert 13 <= len(fast) <= 27
    assert slow == pytest.approx(fast, abs=0.05)
    assert edges(0.4, 1000, seed=3) != fast
    assert driven(Rocking(), repeat(STILL, 200))[-1].edges == 0


def test_rocking_ends_within_two_seconds_of_standing_still():
    for seed in range(20):
        *_, driving = driven(Rocking(), repeat(AHEAD, 800), seed)
        still = driven(driving, repeat(STILL, 250), seed)
        assert max(size_rad(s) for s in still[:50]) > math.radians(1.0)
        assert max(size_rad(s) for s in still[200:]) < math.radians(0.5)


def test_state_without_motion_stays_level_and_levels_scale_it():
    assert driven(Rocking(), repeat(STILL, 100))[-1].tilt(1.0) == (0.0, 0.0)
    *_, driving = driven(Rocking(), repeat(AHEAD, 500))
    assert driving.tilt(0.0) == (0.0, 0.0)
    assert driving.tilt(0.5) == (driving.pitch_rad / 2, driving.roll_rad / 2)
    assert driving.lifted().tilt(1.0) == (0.0, 0.0)
    assert driving.lifted().edges == driving.edges


def test_drawn_tilts_have_the_spread_asked_for_on_both_axes():
    rng = np.random.default_rng(1)
    tilts = np.array([drawn(0.05, rng) for _ in range(4000)])
    assert tilts.std(axis=0) == pytest.approx([0.05, 0.05], rel=0.05)
    assert abs(np.corrcoef(tilts.T)[0, 1]) < 0.05


@pytest.fixture(scope="module")
def hall(room_data):
    room = {**room_data["rooms"][0], "x_m": [0, 20], "y_m": [0, 20]}
    start = {"x_m": 10.0, "y_m": 10.0}
    return WorldFile.model_validate({**room_data, "rooms": [room], "furniture": [], "start": start})


def rocking_robot(hall, level, seed=1):
    levels = Disturbances(rocking=level)
    return Simulation(hall, SimulationSettings(render=False, imu=True, disturbances=levels), seed)


def tilts_of_a_drive(simulation, seed, legs=4):
    """Pitch and roll, (n, 2) radians, at every frame in motion: legs of 8 s out and back, rests between."""
    rng, tilts = np.random.default_rng(seed), []
    simulation.reset(seed, (10.0, 10.0, 0.7))
    heading_rad = float(rng.uniform(-math.pi, math.pi))
    for leg in range(legs):
        for _ in range(27):
            wanted_rad = heading_rad + math.pi * leg + 0.1 * rng.standard_normal()
            simulation.command(*towards(wanted_rad), ttl_s=0.3)
            simulation.step(0.3)
            tilts += [simulation.rocked()] if simulation.truth().speed_mps > 0.1 else []
        simulation.step(2.0)
    return np.array(tilts)


def test_tilt_of_frames_while_driving_has_three_degrees_on_each_axis(hall):
    simulation = rocking_robot(hall, 1.0)
    tilts = np.concatenate([tilts_of_a_drive(simulation, seed) for seed in range(5)])
    assert len(tilts) > 500
    assert np.sqrt((tilts**2).mean(axis=0)) == pytest.approx([RMS_RAD, RMS_RAD], rel=0.1)


def test_a_drive_rocks_the_same_again_after_a_reset_and_half_as_much_at_half_the_level(hall):
    simulation = rocking_robot(hall, 1.0)
    first = tilts_of_a_drive(simulation, 5, legs=1)
    assert (tilts_of_a_drive(simulation, 6, legs=1) != first).any()
    assert (tilts_of_a_drive(simulation, 5, legs=1) == first).all()
    assert tilts_of_a_drive(rocking_robot(hall, 0.5), 5, legs=1) == pytest.approx(first / 2)
    assert (tilts_of_a_drive(rocking_robot(hall, 0.0), 5, legs=1) == 0.0).all()


def test_reset_and_being_put_elsewhere_end_it_at_once(hall):
    for end in (lambda s: s.reset(1), lambda s: s.place_robot(5.0, 5.0, 0.0)):
        simulation = rocking_robot(hall, 1.0)
        simulation.command(SPEED_MPS)
        simulation.step(1.5)
        assert simulation.rocked() != (0.0, 0.0)
        end(simulation)
        assert simulation.rocked() == (0.0, 0.0)


def test_imu_of_a_rocking_robot_reads_its_tilt(hall):
    simulation = rocking_robot(hall, 1.0)
    simulation.command(*towards(0.3))
    errors = []
    for _ in range(100):
        simulation.step(0.1)
        pitch_rad, roll_rad = simulation.rocked()
        x, y, z = simulation.gravity()
        # Nose down: gravity lies ahead of the camera's own "down"; left up: to its right.
        errors.append((math.atan2(x, -z) - pitch_rad, math.atan2(-y, -z) - roll_rad))
    assert np.degrees(errors).std(axis=0) == pytest.approx([0.3, 0.3], rel=0.25)
    assert abs(np.degrees(errors).mean(axis=0)).max() < 0.1
