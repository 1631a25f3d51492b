"""All votes of a scene, computed once: a run picks keypoints, and its heading is a sum over this table."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from experiments.monte_carlo.scene import MonteCarloScene, lonlat_from
from services.planner.heading.votes import latitude_votes, pair_votes
from services.planner.heading.weights import WeightSettings
from shared.geometry.sphere import FloatArray

ComplexArray = npt.NDArray[np.complex128]
IndexArray = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class VoteTable:
    """Votes as complex numbers, x ahead and y to the left.

    Attributes:
        pairs: (K, K) of method 1, symmetric, zero on the diagonal.
        weighted_pairs: (K, K) of method 2 divided by exp(pair_scale).
        singles: (K,) of method 3.
        weighted_singles: (K,) of method 4 divided by exp(single_scale).
        pair_scale: largest logarithm of a pair's weight.
        single_scale: largest logarithm of a single match's weight.
    """

    pairs: ComplexArray
    weighted_pairs: ComplexArray
    singles: ComplexArray
    weighted_singles: ComplexArray
    pair_scale: float
    single_scale: float


def vote_table(scene: MonteCarloScene, weight: WeightSettings) -> VoteTable:
    """Votes of all pairs and all keypoints of a scene, by the planner's own code.

    Args:
        scene: places and keypoints.
        weight: a function of the angle alone; 'rank' depends on the chosen matches and has no table.

    Raises:
        ValueError: the weight is 'rank'.
    """
    if weight.name == "rank":
        raise ValueError("weight 'rank' depends on the other matches: use the methods themselves")
    current, target = lonlat_from(scene.current, scene.points), lonlat_from(scene.target, scene.points)
    count = len(current)
    votes, singles = pair_votes(current, target), latitude_votes(current, target)
    pair_logs, single_logs = weight.log_weights(votes.growth_rad), weight.log_weights(singles.growth_rad)
    pair_scale, single_scale = float(pair_logs.max()), float(single_logs.max())
    plain, alone = _complex(votes.directions), _complex(singles.directions)
    return VoteTable(
        _symmetric(plain, count),
        _symmetric(plain * np.exp(pair_logs - pair_scale), count),
        alone,
        alone * np.exp(single_logs - single_scale),
        pair_scale,
        single_scale,
    )


def draw_choices(runs: int, most: int, of: int, rng: np.random.Generator) -> IndexArray:
    """(runs, most) keypoints per run, in random order, none twice."""
    return np.argsort(rng.random((runs, of)), axis=1)[:, :most]


def headings(table: VoteTable, chosen: IndexArray, counts: tuple[int, ...]) -> FloatArray:
    """Headings of methods 1 to 6, (6, counts, runs), radians.

    The first n keypoints of a row are its run with n matches: runs of different counts share keypoints, which
    makes the counts comparable and every pair is looked up once.
    """
    runs, most = chosen.shape
    at = np.array(counts) - 1
    pairs, weighted_pairs = (np.zeros((runs, most), complex) for _ in range(2))
    for j in range(1, most):
        before, new = chosen[:, :j], chosen[:, j, None]
        pairs[:, j] = table.pairs[before, new].sum(axis=1)
        weighted_pairs[:, j] = table.weighted_pairs[before, new].sum(axis=1)
    sums = [
        np.cumsum(parts, axis=1)[:, at].T
        for parts in (pairs, weighted_pairs, table.singles[chosen], table.weighted_singles[chosen])
    ]
    one, two, three, four = sums
    five = _add(one, 0.0, four, table.single_scale)
    six = _add(two, table.pair_scale, four, table.single_scale)
    return np.asarray(np.angle(np.stack([one, two, three, four, five, six])), np.float64)


def _complex(directions: FloatArray) -> ComplexArray:
    return np.asarray(directions[:, 0] + 1j * directions[:, 1])


def _symmetric(values: ComplexArray, count: int) -> ComplexArray:
    table = np.zeros((count, count), complex)
    table[np.triu_indices(count, 1)] = values
    return table + table.T


def _add(a: ComplexArray, a_scale: float, b: ComplexArray, b_scale: float) -> ComplexArray:
    """Raw sum (Q7) of two vectors that are kept on different scales."""
    common = max(a_scale, b_scale)
    return np.asarray(a * np.exp(a_scale - common) + b * np.exp(b_scale - common))
