"""Where a box comes nearer says how the scanner sits."""

import math

import pytest

from services.launcher.checking.distances import box_problems, free_m, nearer_sector, range_problems

FREE_M = [3.0] * 12


def test_the_sector_that_a_box_made_shorter_is_found_and_noise_is_not():
    boxed = [*FREE_M[:3], 0.8, *FREE_M[4:]]
    assert nearer_sector(FREE_M, boxed) == 3
    assert nearer_sector(FREE_M, [2.95] * 12) is None


@pytest.mark.parametrize(("direction_rad", "found_m"), [(0.0, 2.0), (math.pi, 3.0), (-math.pi / 2, 0.5)])
def test_free_is_what_the_sectors_towards_a_direction_say(direction_rad, found_m):
    near = [3.0, 2.0, *[3.0] * 6, 0.5, *[3.0] * 3]
    assert free_m(near, direction_rad) == found_m


@pytest.mark.parametrize(
    ("ahead", "left", "named"),
    [
        (0, 3, ""),
        (11, 2, ""),
        (0, 9, "scan.upside_down"),
        (3, 0, "scan.upside_down"),
        (3, 6, "the box ahead was seen at +90 degrees"),
        (6, 9, "take these from scan.yaw_deg"),
        (0, 6, "put them anew"),
        (None, 3, "blind there"),
        (None, None, "neither box"),
    ],
)
def test_a_scanner_that_sits_otherwise_is_named(ahead, left, named):
    problems = box_problems(ahead, left)
    assert bool(problems) == bool(named)
    assert named in "".join(problems)


def test_distances_that_hang_or_see_nothing_are_named():
    other = [[*FREE_M[:11], 1.0 + 0.01 * k] for k in range(3)]
    assert range_problems(other, 4.0) == []
    assert "again and again" in range_problems([FREE_M] * 3, 4.0)[0]
    assert "100% of the distances see nothing within 1 m" in range_problems(other, 1.0)[0]
    assert "no distances" in range_problems([], 4.0)[0]
