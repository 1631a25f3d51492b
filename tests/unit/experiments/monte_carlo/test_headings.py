"""The batches of the Monte Carlo study give the headings of the planner's own methods."""

import numpy as np
import pytest
import torch

from experiments.monte_carlo.ahae import DEG, METHODS, AhaePlan, scene_errors
from experiments.monte_carlo.batched import all_headings, batch_headings
from experiments.monte_carlo.scene import (
    HEIGHT_M,
    PLACEMENTS,
    SIDE_M,
    MonteCarloScene,
    draw_choices,
    draw_scene,
    lonlat_from,
)
from experiments.monte_carlo.tracking import DcpePlan, follow, scene_paths
from services.planner.heading.methods import heading_estimate
from shared.geometry.sphere import wrap_rad


def expected(scene, chosen, method):
    current, target = lonlat_from(scene.current, scene.points), lonlat_from(scene.target, scene.points)
    found = [heading_estimate(method, current[row], target[row]).heading_rad for row in chosen]
    return np.array(found)


@pytest.mark.parametrize("placement", PLACEMENTS)
@pytest.mark.parametrize("method", METHODS)
def test_batches_are_the_methods_of_the_planner(placement, method):
    rng = np.random.default_rng(4)
    scene = draw_scene(placement, rng, keypoints=60)
    chosen = draw_choices(8, 34, 60, rng)
    current, target = lonlat_from(scene.current, scene.points), lonlat_from(scene.target, scene.points)
    seen = torch.as_tensor(current[chosen]), torch.as_tensor(target[chosen])
    wanted = expected(scene, chosen, method)
    together = all_headings(*seen, DEG)[METHODS.index(method)]
    for found in (batch_headings(method, *seen, DEG), together):
        assert np.abs(wrap_rad(found.numpy() - wanted)).max() < 1e-9


@pytest.mark.parametrize(
    ("placement", "longitudes", "headings_deg"),
    [("north", (-180.0, 0.0), (0.0, 180.0)), ("north_east", (-180.0, -90.0), (0.0, 90.0))],
)
def test_a_placement_limits_keypoints_and_headings_as_the_thesis_says(placement, longitudes, headings_deg):
    for seed in range(20):
        scene = draw_scene(placement, np.random.default_rng(seed))
        seen = np.rad2deg(lonlat_from(scene.target, scene.points)[:, 0])
        assert longitudes[0] <= seen.min() <= seen.max() <= longitudes[1]
        assert headings_deg[0] <= np.rad2deg(scene.heading_rad) <= headings_deg[1]
        assert np.abs(scene.points).max(axis=0) == pytest.approx([SIDE_M / 2, SIDE_M / 2, HEIGHT_M], rel=0.05)


def test_errors_fall_with_the_number_of_matches_and_depend_on_the_seed_alone():
    plan = AhaePlan("centre", 0, 1, runs=50, counts=(5, 60))
    first = scene_errors(plan)
    assert (first[0, :, 1] < first[0, :, 0]).all()
    np.testing.assert_array_equal(first, scene_errors(plan))
    assert not np.array_equal(first, scene_errors(AhaePlan("centre", 1, 1, runs=50, counts=(5, 60))))


def test_a_perfect_guide_covers_the_straight_way_and_a_lost_one_twice_it():
    scene = MonteCarloScene(np.ones((4, 3)), np.array([0.0, 0.0]), np.array([5.0, 0.0]))
    for heading_rad, covered in ((0.0, 0.0), (np.pi, 100.0)):
        found = follow(scene, scene.points[None], lambda c, _, to=heading_rad: torch.full((len(c),), to))
        assert found[0] == pytest.approx(covered, abs=1e-5)


def test_paths_in_the_middle_of_many_keypoints_are_nearly_straight():
    covered = scene_paths(DcpePlan("centre", 1, 1, runs=3, count=60))
    assert covered.shape == (6, 3)
    assert (covered >= 0.0).all()
    assert (covered <= 100.0).all()
    assert covered[0].mean() < 5.0
