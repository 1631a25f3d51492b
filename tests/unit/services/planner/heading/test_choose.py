"""Choice of the heading method: two-view geometry or the one that a profile names, reasons given."""

import numpy as np
import pytest

from services.planner.heading.choose import CONFIDENCE_MIN, choose_heading, heading_by_votes
from services.planner.heading.methods import METHODS, heading_estimate
from shared.geometry.two_view import TwoViewSettings, two_view
from shared.messages.matching import NodeMatch
from tests.unit.services.planner.heading.scenes import ring, see

CURRENT, TARGET = see(ring()), see(ring(), (0.5, 0.4), 0.8)
TRUTH = np.arctan2(0.4, 0.5)


def matched(current=CURRENT, target=TARGET, **changes):
    """What the feature service answers for these matches."""
    result = two_view(current, target, np.random.default_rng(0), TwoViewSettings())
    match = NodeMatch(
        node_id=1,
        raw_matches=len(current),
        inliers=result.inliers,
        status=result.status,
        heading_rad=result.heading_rad,
        yaw_rad=result.yaw_rad,
        confidence=result.confidence,
        matches_rad=np.concatenate([current, target], axis=1).astype(np.float32),
        inlier_mask=result.inlier_mask.astype(np.uint8),
    )
    return match.model_copy(update=changes)


def by_votes(name, rows=slice(None)):
    pairs = matched().matches_rad[rows]
    return heading_estimate(name, pairs[:, :2], pairs[:, 2:])


@pytest.mark.parametrize("name", [*METHODS, "histogram"])
def test_every_name_gives_a_heading(name):
    estimate = heading_estimate(name, CURRENT, TARGET)
    assert -np.pi <= estimate.heading_rad < np.pi
    assert 0.0 < estimate.strength <= 1.0


def test_unknown_name_lists_the_choices():
    with pytest.raises(ValueError, match=r"'7', choose one of histogram, 1, 2, 3, 4, 5, 6"):
        heading_estimate("7", CURRENT, TARGET)


def test_histogram_name_runs_the_method_it_names():
    assert heading_estimate("histogram", CURRENT, TARGET) == heading_estimate("1", CURRENT, TARGET)
    left = CURRENT[:, 0] > 0.2
    c, t = CURRENT[left], TARGET[left]
    assert heading_estimate("histogram", c, t) == heading_estimate("4", c, t)


def test_two_view_heading_comes_first():
    choice = choose_heading(matched(), "epipolar")
    assert choice.method == "epipolar"
    assert choice.estimate.heading_rad == pytest.approx(TRUTH, abs=1e-6)
    assert choice.estimate.strength == matched().confidence
    assert "60 of 60 matches verified" in choice.reason


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"status": "inconsistent"}, "inconsistent"),
        ({"status": "too_few"}, "too_few"),
        ({"confidence": 0.9 * CONFIDENCE_MIN}, "confidence 0.27"),
    ],
)
def test_there_is_no_heading_where_two_view_geometry_has_no_usable_answer(changes, word):
    choice = choose_heading(matched(**changes), "epipolar")
    assert choice.method == "epipolar"
    assert word in choice.reason
    assert choice.estimate.heading_rad is None


def test_turn_on_the_spot_has_no_direction():
    choice = choose_heading(matched(CURRENT, CURRENT), "epipolar")
    assert choice.estimate.heading_rad is None
    assert "only turned" in choice.reason


def test_configured_method_gets_the_verified_matches_only():
    mask = np.ones(60, np.uint8)
    mask[:20] = 0
    match = matched(inlier_mask=mask, inliers=40)
    verified = choose_heading(match, "4")
    assert verified.estimate == by_votes("4", slice(20, None))
    assert "40 of 60 matches verified" in verified.reason
    assert choose_heading(match, "4", verified_only=False).estimate == by_votes("4")


def test_one_wrong_match_decides_a_steep_method_unless_verified():
    current, target = CURRENT.copy(), TARGET.copy()
    current[0], target[0] = (-2.5, 0.05), (0.0, 1.2)
    match = matched(current, target)
    safe = choose_heading(match, "4").estimate.heading_rad
    fooled = choose_heading(match, "4", verified_only=False)
    assert fooled.estimate.heading_rad == pytest.approx(-2.5, abs=1e-3)
    assert abs(safe - TRUTH) < np.deg2rad(60.0)


def test_too_few_matches_give_a_reason_and_no_heading():
    choice = heading_by_votes("1", CURRENT[:2], TARGET[:2], "given")
    assert choice.estimate.heading_rad is None
    assert "2 matches, 3 needed" in choice.reason


def test_without_the_matches_only_two_view_geometry_can_tell():
    bare = matched().model_copy(update={"matches_rad": None, "inlier_mask": None})
    assert choose_heading(bare, "epipolar").estimate.heading_rad is not None
    assert choose_heading(bare, "4").estimate.heading_rad is None
