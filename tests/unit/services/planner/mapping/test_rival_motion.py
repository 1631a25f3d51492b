"""A view that two motions explain is found out; leftovers that agree on nothing are not."""

import math

import numpy as np
import pytest

from services.planner.mapping.rival_motion import is_ambiguous
from shared.messages.matching import NodeMatch

YAW_RAD = 0.4


def views(rng, count, way, noise_rad=0.001, nearest_m=2.0):
    """Bearings (count, 4) of random points from the origin and from `way`, turned by YAW_RAD."""
    angle, out_m = rng.uniform(-math.pi, math.pi, count), rng.uniform(nearest_m, 4 * nearest_m, count)
    points = np.stack(
        [out_m * np.cos(angle), out_m * np.sin(angle), rng.uniform(-1.0, 2.5, count) * nearest_m / 2.0],
        axis=1,
    )
    rows = []
    for origin, turn in ((np.zeros(3), 0.0), (np.array([*way, 0.0]), YAW_RAD)):
        x, y, z = (points - origin).T
        rows += [np.arctan2(y, x) - turn, np.arctan2(z, np.hypot(x, y))]
    return np.stack(rows, axis=1) + rng.normal(0.0, noise_rad, (count, 4))


def wrong(rng, count):
    return rng.uniform([-math.pi, -0.6] * 2, [math.pi, 0.6] * 2, (count, 4))


def match(*agreeing, rest=()):
    """A match whose heading `agreeing` matches explain."""
    rows, count = np.concatenate([*agreeing, *rest]), sum(map(len, agreeing))
    mask = np.zeros(len(rows), np.uint8)
    mask[:count] = 1
    return NodeMatch(
        node_id=3, raw_matches=len(rows), inliers=count, status="ok", heading_rad=0.0,
        yaw_rad=YAW_RAD, confidence=0.9, matches_rad=rows.astype(np.float32), inlier_mask=mask,
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(5))
def test_leftovers_that_agree_on_another_direction_are_a_rival(seed):
    rng = np.random.default_rng(seed)
    assert is_ambiguous(match(views(rng, 80, (2.0, 0.0)), rest=(views(rng, 20, (-1.0, 0.3)), wrong(rng, 15))))


@pytest.mark.parametrize("seed", range(5))
def test_wrong_matches_are_no_rival(seed):
    rng = np.random.default_rng(seed)
    assert not is_ambiguous(match(views(rng, 80, (2.0, 0.0)), rest=(wrong(rng, 40),)))


def test_leftovers_of_the_same_motion_are_no_rival():
    rng = np.random.default_rng(1)
    assert not is_ambiguous(
        match(views(rng, 80, (2.0, 0.0)), rest=(views(rng, 30, (2.0, 0.0), noise_rad=0.004),))
    )


def test_a_handful_is_no_rival_of_many():
    rng = np.random.default_rng(1)
    assert not is_ambiguous(match(views(rng, 300, (2.0, 0.0)), rest=(views(rng, 12, (-1.0, 0.3)),)))


@pytest.mark.parametrize("seed", range(5))
def test_a_few_near_things_are_a_rival_where_all_else_is_far_away(seed):
    rng = np.random.default_rng(seed)
    sky = views(rng, 40, (-1.0, 1.0), nearest_m=60.0)
    assert is_ambiguous(
        match(sky, views(rng, 25, (2.0, 0.0)), rest=(views(rng, 7, (-1.0, 1.0)), wrong(rng, 15)))
    )


def test_what_is_far_away_is_no_rival():
    rng = np.random.default_rng(1)
    sky = views(rng, 40, (-1.0, 1.0), nearest_m=60.0)
    assert not is_ambiguous(match(views(rng, 25, (2.0, 0.0)), rest=(sky, wrong(rng, 15))))


def test_without_the_matches_nothing_can_be_said():
    assert not is_ambiguous(NodeMatch(node_id=3, raw_matches=90, inliers=60, status="ok", heading_rad=0.0))
