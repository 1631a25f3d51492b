"""Registry and choice: the configured method, the fallback, and the reasons given."""

import dataclasses

import numpy as np
import pytest
from pydantic import ValidationError

from services.planner.heading.choose import HeadingSettings, choose_heading
from services.planner.heading.registry import METHOD_NAMES, heading_method
from services.planner.heading.weights import WeightSettings
from shared.geometry.two_view import TwoViewSettings, two_view
from shared.geometry.two_view_types import refused
from tests.unit.services.planner.heading.scenes import ring, see

CURRENT, TARGET = see(ring()), see(ring(), (0.5, 0.4), 0.8)
TRUTH = np.arctan2(0.4, 0.5)
RESULT = two_view(CURRENT, TARGET, np.random.default_rng(0), TwoViewSettings())


def test_every_name_gives_a_heading_with_one_signature():
    for name in METHOD_NAMES:
        estimate = heading_method(name)(CURRENT, TARGET, RESULT)
        assert -np.pi <= estimate.heading_rad < np.pi
        assert 0.0 < estimate.strength <= 1.0


def test_unknown_name_lists_the_choices():
    with pytest.raises(ValueError, match=r"'7', choose one of epipolar, histogram, 1, 2, 3, 4, 5, 6"):
        heading_method("7")
    with pytest.raises(ValidationError):
        HeadingSettings(method="7")


def test_histogram_name_runs_the_method_it_names():
    assert heading_method("histogram")(CURRENT, TARGET, None) == heading_method("1")(CURRENT, TARGET, None)
    left = CURRENT[:, 0] > 0.2
    c, t = CURRENT[left], TARGET[left]
    assert heading_method("histogram")(c, t, None) == heading_method("4")(c, t, None)


def test_two_view_heading_is_the_default():
    choice = choose_heading(HeadingSettings(), CURRENT, TARGET, RESULT)
    assert choice.method == "epipolar"
    assert choice.estimate.heading_rad == pytest.approx(TRUTH, abs=1e-6)
    assert choice.estimate.strength == RESULT.confidence
    assert "60 of 60 matches verified" in choice.reason


@pytest.mark.parametrize(
    ("result", "word"),
    [
        (None, "no two-view result"),
        (refused("inconsistent", np.zeros(60, dtype=bool)), "inconsistent"),
        (refused("too_few", np.zeros(60, dtype=bool)), "too_few"),
        (dataclasses.replace(RESULT, confidence=0.1), "confidence 0.10 too low"),
    ],
)
def test_histogram_decides_where_two_view_has_no_usable_answer(result, word):
    choice = choose_heading(HeadingSettings(), CURRENT, TARGET, result)
    assert choice.method == "1"
    assert word in choice.reason
    assert "so method 1" in choice.reason
    assert choice.estimate == heading_method("1")(CURRENT, TARGET, None)


def test_turn_on_the_spot_has_no_direction():
    same = two_view(CURRENT, CURRENT, np.random.default_rng(0))
    choice = choose_heading(HeadingSettings(), CURRENT, CURRENT, same)
    assert choice.estimate.heading_rad is None
    assert "only turned" in choice.reason


def test_configured_method_gets_the_verified_matches_only():
    mask = RESULT.inlier_mask.copy()
    mask[:20] = False
    result = dataclasses.replace(RESULT, inlier_mask=mask, inliers=40)
    weight = WeightSettings(gain=0.3)
    verified = choose_heading(HeadingSettings(method="4", weight=weight), CURRENT, TARGET, result)
    assert verified.estimate == heading_method("4", weight)(CURRENT[20:], TARGET[20:], None)
    assert "40 verified matches" in verified.reason
    settings = HeadingSettings(method="4", weight=weight, verified_only=False)
    every = choose_heading(settings, CURRENT, TARGET, result)
    assert every.estimate == heading_method("4", weight)(CURRENT, TARGET, None)


def test_one_wrong_match_decides_a_steep_method_unless_verified():
    current, target = CURRENT.copy(), TARGET.copy()
    current[0], target[0] = (-2.5, 0.05), (0.0, 1.2)
    result = two_view(current, target, np.random.default_rng(0))
    steep = HeadingSettings(method="4")
    safe = choose_heading(steep, current, target, result).estimate.heading_rad
    fooled = choose_heading(steep.model_copy(update={"verified_only": False}), current, target, result)
    assert fooled.estimate.heading_rad == pytest.approx(-2.5, abs=1e-3)
    assert abs(safe - TRUTH) < np.deg2rad(60.0)


def test_too_few_matches_give_a_reason_and_no_heading():
    choice = choose_heading(HeadingSettings(method="1"), CURRENT[:2], TARGET[:2], None)
    assert choice.estimate.heading_rad is None
    assert "2 matches, 3 needed" in choice.reason


def test_result_of_other_matches_is_refused():
    with pytest.raises(ValueError, match="mask has 60"):
        choose_heading(HeadingSettings(method="1"), CURRENT[:10], TARGET[:10], RESULT)
