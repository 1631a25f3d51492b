"""Velocity law: the thesis's numbers, and the floor and limit around it."""

import pytest
from pydantic import ValidationError

from services.drive.velocity import WheelLimits, velocity_gain, wheel_speed


@pytest.mark.parametrize(("similarity", "gain"), [(0, 1.0), (90, 1.0), (110, 1.0 - 20 / 150), (150, 0.6)])
def test_gain_of_the_thesis(similarity, gain):
    assert velocity_gain(similarity, s_slow=90, s_max=150) == pytest.approx(gain)


def test_outdoor_speed_falls_from_ten_to_six():
    limits = WheelLimits(max_radps=10.0, min_radps=6.0)
    assert wheel_speed(60, 90, 150, 1.0, limits) == 10.0
    assert wheel_speed(150, 90, 150, 1.0, limits) == pytest.approx(6.0)


def test_minimum_speed_is_kept_until_the_planner_asks_for_less():
    limits = WheelLimits(max_radps=5.0, min_radps=4.0)
    assert wheel_speed(150, 90, 150, 1.0, limits) == 4.0
    assert wheel_speed(150, 90, 150, 0.25, limits) == 1.0


def test_minimum_above_maximum_is_refused():
    with pytest.raises(ValidationError, match="min_radps must be at most max_radps"):
        WheelLimits(max_radps=3.0, min_radps=5.0)
