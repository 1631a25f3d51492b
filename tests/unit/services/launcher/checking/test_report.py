"""What a check calls wrong about delays and stops."""

import pytest

from services.launcher.checking.report import Stops, delay_problems, stop_problems


@pytest.mark.parametrize(
    ("ages_s", "named"),
    [([0.1, 0.3], ""), ([0.1, 0.9], "0.90 s old"), ([-0.4, 0.1], "0.40 s in the future"), ([], "")],
)
def test_late_pictures_and_clocks_ahead_are_named(ages_s, named):
    problems = delay_problems(ages_s)
    assert bool(problems) == bool(named)
    assert named in "".join(problems)


@pytest.mark.parametrize(
    ("stops", "count"),
    [
        (Stops(0.2, 0.1), 0),
        (Stops(None, None), 0),
        (Stops(0.8, 0.1), 1),
        (Stops(0.2, 0.9), 1),
        (Stops(0.2, 0.1, obeyed=False), 1),
    ],
)
def test_a_robot_that_stands_too_late_is_not_to_drive(stops, count):
    problems = stop_problems(stops)
    assert len(problems) == count
    assert all("do not let it drive" in one for one in problems)
