"""Methods 1 to 6 against values computed by hand."""

import numpy as np
import pytest

from services.planner.heading.methods import METHODS, heading_estimate, heading_vector
from services.planner.heading.votes import latitude_votes, pair_votes
from services.planner.heading.weights import UNWEIGHTED, WeightSettings
from shared.geometry.sphere import wrap_rad
from tests.unit.services.planner.heading.scenes import deg, ring, see

EXP = WeightSettings()
THESIS_NAMES = list(METHODS)


@pytest.mark.parametrize(
    ("current", "target", "vote"),
    [
        pytest.param((30, -30), (45, -45), (1.0, 0.0), id="pair spreads: along its bisector"),
        pytest.param((45, -45), (30, -30), (-1.0, 0.0), id="pair closes: against its bisector"),
        pytest.param((45, -45), (-30, 30), (1.0, 0.0), id="order flipped: along, whatever the spread"),
        pytest.param((30, -30), (-45, 45), (1.0, 0.0), id="order flipped while spreading: along"),
        pytest.param((170, -170), (150, -150), (-1.0, 0.0), id="spreads across the seam: backwards"),
        pytest.param((120, 60), (135, 45), (0.0, 1.0), id="spreads on the left: left"),
        pytest.param((30, -30), (30, -30), (0.0, 0.0), id="unchanged: no vote"),
        pytest.param(
            (30, 30), (40, 20), (np.sqrt(3) / 2, 0.5), id="one direction splits: half order, full vote"
        ),
    ],
)
def test_vote_of_one_pair(current, target, vote):
    votes = pair_votes(deg(*[(a, 0) for a in current]), deg(*[(a, 0) for a in target]))
    np.testing.assert_allclose(votes.directions, [vote], atol=1e-12)


@pytest.mark.parametrize(
    ("current", "target", "growth"),
    [((30, -30), (45, -45), 30.0), ((170, -170), (150, -150), 40.0), ((10, -10), (-10, 10), 0.0)],
)
def test_growth_of_a_pair_is_the_wrapped_change_of_its_difference(current, target, growth):
    votes = pair_votes(deg(*[(a, 0) for a in current]), deg(*[(a, 0) for a in target]))
    np.testing.assert_allclose(np.rad2deg(votes.growth_rad), [growth], atol=1e-9)


@pytest.mark.parametrize(("count", "pairs"), [(2, 1), (60, 1770), (150, 11_175)])
def test_pairs_are_unordered(count, pairs):
    matches = see(ring(count))
    assert len(pair_votes(matches, matches).growth_rad) == pairs


def test_antipodal_pair_is_skipped():
    current, target = deg((0, 0), (180, 0)), deg((0, 0), (170, 0))
    np.testing.assert_array_equal(pair_votes(current, target).directions, [[0.0, 0.0]])
    assert heading_estimate("1", current, target).heading_rad is None


@pytest.mark.parametrize(
    ("lat_current", "lat_target", "factor"),
    [
        pytest.param(10, 20, 1.0, id="rises above: toward"),
        pytest.param(20, 10, -1.0, id="sinks above: away"),
        pytest.param(-10, -20, 1.0, id="sinks below: toward"),
        pytest.param(-20, -10, -1.0, id="rises below: away"),
        pytest.param(20, -10, 1.0, id="crosses the horizon: counts as in front"),
        pytest.param(15, 15, 0.0, id="unchanged: no vote"),
        pytest.param(15, -15, 1.0, id="mirrored: counts as in front"),
        pytest.param(15, 0, 0.0, id="onto the horizon: half order"),
    ],
)
def test_vote_of_one_latitude(lat_current, lat_target, factor):
    votes = latitude_votes(deg((60, lat_current)), deg((-100, lat_target)))
    np.testing.assert_allclose(votes.directions, [[factor * 0.5, factor * np.sqrt(3) / 2]], atol=1e-12)
    growth = np.deg2rad(abs(lat_target) - abs(lat_current))
    np.testing.assert_allclose(votes.growth_rad, [growth], atol=1e-12)


def vector(name, current, target, *how):
    resultant = heading_vector(name, current, target, *how)
    return resultant.vector * np.exp(resultant.log_scale)


def test_exponential_of_degrees_weighs_by_hand():
    current, target = deg((0, 10), (90, 10)), deg((0, 12), (90, 13))
    np.testing.assert_allclose(vector("4", current, target, EXP), [np.exp(2.0), np.exp(3.0)], rtol=1e-9)
    radians = WeightSettings(unit="rad", gain=10.0)
    expected = np.exp(10.0 * np.deg2rad([2.0, 3.0]))
    np.testing.assert_allclose(vector("4", current, target, radians), expected, rtol=1e-9)


def test_unweighted_methods_2_and_4_are_methods_1_and_3():
    current, target = see(ring()), see(ring(), (0.6, 0.3), 1.0)
    np.testing.assert_allclose(
        vector("2", current, target, UNWEIGHTED), vector("1", current, target), atol=1e-12
    )
    np.testing.assert_allclose(
        vector("4", current, target, UNWEIGHTED), vector("3", current, target), atol=1e-12
    )


def test_methods_5_and_6_add_method_4_to_1_and_2():
    current, target = see(ring(20)), see(ring(20), (0.3, -0.2), 0.5)
    weight = WeightSettings(gain=0.1)
    four = vector("4", current, target, weight)
    one, two = vector("1", current, target), vector("2", current, target, weight)
    np.testing.assert_allclose(vector("5", current, target, weight), one + four, rtol=1e-9)
    np.testing.assert_allclose(vector("6", current, target, weight), two + four, rtol=1e-9)
    halves = one / np.linalg.norm(one) + four / np.linalg.norm(four)
    np.testing.assert_allclose(vector("5", current, target, weight, "unit"), halves, rtol=1e-9)


@pytest.mark.parametrize("name", THESIS_NAMES)
@pytest.mark.parametrize("heading_deg", [0.0, 90.0, 180.0, -60.0])
def test_features_all_around_give_the_direction_of_travel(name, heading_deg):
    """Regular ring of features on both sides of the horizon: symmetric, so all methods agree."""
    angle = np.deg2rad(np.arange(0.0, 360.0, 10.0))
    points = np.stack([3 * np.cos(angle), 3 * np.sin(angle), np.where(np.arange(36) % 2, 1.0, -1.0)], axis=1)
    heading = np.deg2rad(heading_deg)
    target = see(points, 0.4 * np.array([np.cos(heading), np.sin(heading)]), yaw_rad=0.3)
    estimate = heading_estimate(name, see(points), target, WeightSettings(gain=0.2))
    assert abs(np.rad2deg(wrap_rad(estimate.heading_rad - heading))) < 8.0
    assert 0.0 < estimate.strength <= 1.0


@pytest.mark.parametrize("name", THESIS_NAMES)
@pytest.mark.parametrize("yaw", [0.1, 1.0, np.pi, -2.5])
def test_yaw_of_the_target_does_not_alter_the_heading(name, yaw):
    current = see(ring())
    straight = heading_estimate(name, current, see(ring(), (0.5, 0.4)))
    turned = heading_estimate(name, current, see(ring(), (0.5, 0.4), yaw))
    assert abs(float(wrap_rad(straight.heading_rad - turned.heading_rad))) < 1e-9


@pytest.mark.parametrize("name", THESIS_NAMES)
def test_turning_the_current_frame_turns_the_heading_with_it(name):
    target = see(ring(), (0.5, 0.4))
    straight = heading_estimate(name, see(ring()), target)
    turned = heading_estimate(name, see(ring(), yaw_rad=0.7), target)
    assert abs(float(wrap_rad(straight.heading_rad - 0.7 - turned.heading_rad))) < 1e-9


@pytest.mark.parametrize("name", THESIS_NAMES)
@pytest.mark.parametrize("yaw", [0.0, 1.0])
def test_identical_frames_name_no_direction_for_votes_without_rounding_noise(name, yaw):
    estimate = heading_estimate(name, see(ring()), see(ring(), yaw_rad=yaw))
    assert (estimate.heading_rad, estimate.strength) == (None, 0.0)


@pytest.mark.parametrize("name", THESIS_NAMES)
@pytest.mark.parametrize("count", [0, 1])
def test_hardly_any_match_raises_nothing(name, count):
    current, target = see(ring(count)), see(ring(count), (0.5, 0.0))
    estimate = heading_estimate(name, current, target)
    assert estimate.heading_rad is None or count == 1


def test_steep_weights_do_not_overflow():
    current, target = deg((10, 1), (-20, 2), (90, 3)), deg((170, 80), (-170, 85), (0, 60))
    for name in THESIS_NAMES:
        estimate = heading_estimate(name, current, target, WeightSettings(gain=100.0))
        assert np.isfinite(estimate.heading_rad)
        assert np.isfinite(estimate.strength)
