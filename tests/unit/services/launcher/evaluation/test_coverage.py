"""Coverage: hand-computed fractions, and no floor is an error."""

import numpy as np
import pytest

from services.launcher.evaluation.coverage import coverage

FLOOR_M = np.stack(np.meshgrid(np.arange(10.0), [0.0]), axis=-1).reshape(-1, 2)


def test_floor_at_most_the_radius_away_counts_and_the_rest_does_not():
    assert coverage(FLOOR_M, np.array([[0.0, 0.0], [5.0, 0.0]]), 1.0) == 0.5  # 0, 1 and 4, 5, 6


def test_a_map_without_nodes_covers_nothing():
    assert coverage(FLOOR_M, np.zeros((0, 2))) == 0.0


def test_many_cells_give_the_same_as_few():
    rng = np.random.default_rng(1)
    floor_m, nodes_m = rng.uniform(0, 20, (10_000, 2)), rng.uniform(0, 20, (30, 2))
    near = [bool((np.hypot(*(nodes_m - point).T) <= 1.0).any()) for point in floor_m]
    assert coverage(floor_m, nodes_m) == pytest.approx(np.mean(near))


def test_no_floor_is_an_error():
    with pytest.raises(ValueError, match="at least one point"):
        coverage(np.zeros((0, 2)), np.zeros((1, 2)))
