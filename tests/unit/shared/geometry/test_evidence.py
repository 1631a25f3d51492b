"""Trust in a two-view answer: chance, parallax above the noise, and limits that refuse."""

import dataclasses

import numpy as np
import pytest

from shared.geometry.evidence import confidence, disparity_rad, log_nfa, parallax_share, sign_margin
from shared.geometry.planar import estimate_planar
from shared.geometry.two_view_types import TwoViewSettings
from tests.unit.shared.geometry.synthetic_room import make_scene

LIMITS = TwoViewSettings()


def test_false_alarms_by_hand():
    assert log_nfa(12, 12, 0.1, 2, 100) == pytest.approx(np.log(100.0) + 10.0 * np.log(0.1))
    assert log_nfa(3, 22, 0.1, 2, 100) == pytest.approx(
        np.log(100.0)
    )  # below the mean of chance: no evidence


def test_share_of_parallax_by_hand():
    assert parallax_share(0.0166510, 0.005) == pytest.approx(0.75, abs=1e-4)
    assert parallax_share(0.001, 0.005) == pytest.approx(1e-3)


def test_disparity_is_the_median_or_half_of_what_the_nearest_fifth_exceeds():
    assert disparity_rad(np.array([0.02, 0.04, 0.06, 0.08, 0.10])) == pytest.approx(0.06)
    assert disparity_rad(np.array([0.0, 0.0, 0.0, 0.3, 0.4, 0.5])) == pytest.approx(0.2)


def test_sign_margin_is_the_net_share_of_clipped_evidence():
    assert sign_margin(np.array([9.0, 9.0, 9.0, -9.0]), np.ones(4), 1.0) == pytest.approx(0.5)
    assert sign_margin(np.array([-9.0]), np.ones(1), 1.0) == 0.0


def test_confidence_is_the_product_of_its_shares():
    sure = confidence(50, 50, 0.05, -100.0, 0.0, 1.0)
    assert sure == pytest.approx(1.0, abs=1e-6)
    assert confidence(50, 50, 0.05, -100.0, np.deg2rad(10.0), 1.0) == pytest.approx(0.5, abs=1e-6)
    assert confidence(50, 50, 0.05, -100.0, 0.0, 0.4) == pytest.approx(0.4, abs=1e-6)
    assert confidence(10, 110, 0.05, -100.0, 0.0, 1.0) == pytest.approx(1.0 - 100.0 / 19.0 / 10.0, abs=1e-6)


def test_many_wrong_matches_that_fit_by_chance_are_refused():
    for seed in range(4):
        scene = make_scene(np.random.default_rng(seed), 300, 300)
        result = estimate_planar(scene.current, scene.target, np.random.default_rng(0), LIMITS)
        assert result.inliers >= LIMITS.min_inliers  # chance passes the count, so the evidence has to refuse
        assert result.status == "inconsistent"


def test_direction_looser_than_the_limit_is_refused():
    scene = make_scene(np.random.default_rng(1), 60)
    strict = dataclasses.replace(LIMITS, max_heading_std_rad=1e-5)
    assert (
        estimate_planar(scene.current, scene.target, np.random.default_rng(0), strict).status
        == "inconsistent"
    )
