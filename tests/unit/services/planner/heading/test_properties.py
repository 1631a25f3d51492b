"""What every heading method must leave unchanged, on generated scenes."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.planner.heading.methods import heading_estimate
from tests.unit.services.planner.heading.scenes import ring, see

NAMES = ("1", "2", "3", "4", "5", "6", "histogram")
DISTANCE = st.floats(0.3, 1.5)
ANGLE = st.floats(-3.1, 3.1)
SCENES = {"seed": st.integers(0, 10_000), "count": st.integers(8, 40), "away_m": DISTANCE, "towards": ANGLE}


def views(seed, count, away_m, towards):
    points = ring(count, seed)
    return see(points), see(points, (away_m * np.cos(towards), away_m * np.sin(towards)))


def heading(name, current, target):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        estimate = heading_estimate(name, current, target)
    assert estimate.heading_rad is None or isinstance(estimate.heading_rad, float)
    return estimate


def same(first, second):
    """Equal directions, unless the votes nearly cancel and rounding decides."""
    if min(first.strength, second.strength) < 1e-6:
        return True
    return abs(np.angle(np.exp(1j * (first.heading_rad - second.heading_rad)))) < 1e-6


@pytest.mark.parametrize("name", NAMES)
@given(**SCENES, turn=ANGLE)
@settings(max_examples=25, deadline=None)
def test_a_turn_of_the_target_camera_changes_nothing(name, seed, count, away_m, towards, turn):
    current, target = views(seed, count, away_m, towards)
    turned = target + np.array([turn, 0.0])
    turned[:, 0] = np.angle(np.exp(1j * turned[:, 0]))
    assert same(heading(name, current, target), heading(name, current, turned))


@pytest.mark.parametrize("name", NAMES)
@given(**SCENES)
@settings(max_examples=25, deadline=None)
def test_the_order_of_the_matches_does_not_matter(name, seed, count, away_m, towards):
    current, target = views(seed, count, away_m, towards)
    order = np.random.default_rng(seed).permutation(count)
    assert same(heading(name, current, target), heading(name, current[order], target[order]))


@pytest.mark.parametrize("name", [n for n in NAMES if n != "histogram"])
@given(**SCENES)
@settings(max_examples=25, deadline=None)
def test_a_mirrored_scene_has_the_mirrored_heading(name, seed, count, away_m, towards):
    current, target = views(seed, count, away_m, towards)
    mirror = np.array([-1.0, 1.0])
    straight, mirrored = heading(name, current, target), heading(name, current * mirror, target * mirror)
    if straight.heading_rad is None:
        assert mirrored.heading_rad is None
        return
    flipped = type(straight)(-straight.heading_rad, straight.strength)
    assert same(flipped, mirrored)


@pytest.mark.parametrize("name", NAMES)
@given(**SCENES, up=st.booleans())
@settings(max_examples=15, deadline=None)
def test_a_scene_turned_upside_down_has_the_same_heading(name, seed, count, away_m, towards, up):
    current, target = views(seed, count, away_m, towards)
    flip = np.array([1.0, 1.0 if up else -1.0])
    assert same(heading(name, current, target), heading(name, current * flip, target * flip))
