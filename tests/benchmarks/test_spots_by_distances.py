"""Whether twelve distances tell a spot from another one that looks the same; gates nothing.

pytest -q -s tests/benchmarks/test_spots_by_distances.py
WORLDS=yard-3-small,factory pytest -q -s tests/benchmarks/test_spots_by_distances.py

Along a corrugated wall, views of spots 1.6 m apart agree as if they were one (perceptual aliasing). How many
of the distances differ between a spot and another one at most AT_SPOT_M off, and one ELSEWHERE_M off?
"""

import os

import numpy as np
import pytest

from experiments.generated.row import RANGE, RANGE_M
from services.launcher.client.environments import environment_of
from simulator.sensors.ranges import measure
from simulator.settings import RangeSettings
from simulator.world.footprints import footprints
from simulator.world.freespace import free_space
from tests.benchmarks.test_exploring_plans import world_of

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

WORLDS = "apartment,factory,yard-0-small,yard-3-small"
SPOTS, PAIRS = 400, 2
AT_SPOT_M, ELSEWHERE_M = 0.3, (0.8, 2.5)
SLACK_M, SLACK_SHARE = 0.4, 0.3
"""Readings of one thing from spots AT_SPOT_M apart differ by less; chosen."""
BAND_M = (0.02, 0.79)
"""Heights of what the sensors see, as in tests/plane_world.py."""


def differing(first_m, second_m):
    """How many of two times twelve readings (12,) differ by more than those of one spot do."""
    slack_m = SLACK_M + SLACK_SHARE * np.minimum(first_m, second_m)
    return int((np.abs(first_m - second_m) > slack_m).sum())


def shares(counts):
    """Share of pairs in which more than so many readings differ."""
    return {f"more_than_{most}": float((np.array(counts) > most).mean()) for most in range(1, 6)}


@pytest.mark.parametrize("name", os.environ.get("WORLDS", WORLDS).split(","))
def test_how_many_of_twelve_distances_differ(name, tmp_path, keep):
    rng, world = np.random.default_rng(1), world_of(name, tmp_path)
    space = free_space(world)
    shapes, floor_m = footprints(space.parts, *BAND_M), space.centres_m()
    sensors = RangeSettings(max_m=float(environment_of(world).variables.get(RANGE, RANGE_M)))
    at_spot, elsewhere = [], []
    for spot_m in floor_m[rng.integers(len(floor_m), size=SPOTS)]:
        here = measure(*spot_m, 0.0, shapes, sensors, rng)
        away_m = np.linalg.norm(floor_m - spot_m, axis=1)
        for counts, chosen in (
            (at_spot, away_m < AT_SPOT_M),
            (elsewhere, (away_m > ELSEWHERE_M[0]) & (away_m < ELSEWHERE_M[1])),
        ):
            for other_m in rng.choice(floor_m[chosen], size=PAIRS):
                counts.append(differing(here, measure(*other_m, 0.0, shapes, sensors, rng)))
    keep({"at_the_spot": shares(at_spot), "elsewhere": shares(elsewhere)})
