"""Weight functions by name, and sums formed from their logarithms."""

import numpy as np
import pytest
from pydantic import ValidationError

from services.planner.heading.estimate import Resultant, weighted_sum
from services.planner.heading.weights import LOG_WEIGHTS, WEIGHT_NAMES, WeightSettings


def weight(name, degrees, **options):
    return float(np.exp(WeightSettings(name=name, **options).log_weights(np.deg2rad([degrees])))[0])


@pytest.mark.parametrize(
    ("name", "degrees", "options", "expected"),
    [
        ("exp", 2.0, {}, np.exp(2.0)),
        ("exp", -3.0, {"gain": 0.5}, np.exp(-1.5)),
        ("exp", 90.0, {"unit": "rad"}, np.exp(np.pi / 2)),
        ("one", 55.0, {}, 1.0),
        ("power", 4.0, {}, 4.0),
        ("power", 4.0, {"gain": 2.0}, 16.0),
        ("power", -4.0, {}, 0.0),
        ("sigmoid", 0.0, {}, 0.5),
        ("sigmoid", 1.0, {}, 1.0 / (1.0 + np.exp(-1.0))),
    ],
)
def test_weight_of_known_angle(name, degrees, options, expected):
    assert weight(name, degrees, **options) == pytest.approx(expected)


def test_ranks_are_shares_and_equal_angles_share_a_place():
    weights = np.exp(WeightSettings(name="rank").log_weights(np.array([0.3, -0.1, 0.3, 0.2])))
    np.testing.assert_allclose(weights, [3.5 / 4, 1 / 4, 3.5 / 4, 2 / 4])


def test_every_name_has_a_function():
    assert set(LOG_WEIGHTS) == set(WEIGHT_NAMES)


@pytest.mark.parametrize("wrong", [{"name": "square"}, {"gain": 0.0}, {"unit": "grad"}, {"gian": 2.0}])
def test_wrong_settings_are_refused(wrong):
    with pytest.raises(ValidationError):
        WeightSettings(**wrong)


def test_default_is_the_exponential_of_degrees():
    assert WeightSettings() == WeightSettings(name="exp", gain=1.0, unit="deg")


def test_sum_keeps_its_scale_apart():
    total = weighted_sum(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([1000.0, 1000.0 + np.log(3.0)]))
    np.testing.assert_allclose(total.vector / np.hypot(*total.vector), np.array([1.0, 3.0]) / np.sqrt(10.0))
    assert total.log_scale == pytest.approx(1000.0 + np.log(3.0))
    assert total.estimate().strength == pytest.approx(np.sqrt(10.0) / 4.0)


def test_resultants_of_different_scales_add_up():
    a, b = (
        Resultant(np.array([1.0, 0.0]), 1.0, np.log(2.0)),
        Resultant(np.array([0.0, 1.0]), 1.0, np.log(6.0)),
    )
    both = a + b
    np.testing.assert_allclose(both.vector * np.exp(both.log_scale), [2.0, 6.0])
    assert both.total * np.exp(both.log_scale) == pytest.approx(8.0)


def test_parts_that_cancel_name_no_direction():
    estimate = weighted_sum(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.zeros(2)).estimate()
    assert (estimate.heading_rad, estimate.strength) == (None, 0.0)


def test_weights_of_zero_are_left_out():
    estimate = weighted_sum(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([-np.inf, 0.0])).estimate()
    assert estimate.heading_rad == pytest.approx(np.pi / 2)
    assert weighted_sum(np.ones((1, 2)), np.array([-np.inf])).estimate().heading_rad is None
