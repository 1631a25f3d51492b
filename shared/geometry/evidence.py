"""How far a two-view answer can be trusted: against chance, by its parallax, by its spread."""

import numpy as np

from shared.geometry.sphere import FloatArray

NOISE_FLOOR_RAD = 5e-4
"""A sixteenth of a pixel at 800 columns: no keypoint is localised better, however well few matches agree."""
PRECISE_RAD = float(np.deg2rad(10.0))
"""Spread of a heading that halves the confidence; chosen: half of TwoViewSettings.max_heading_std_rad."""
SURE_LOG_NFA = -5.0
"""Evidence at which chance is out of the question: confidence 1 - 1/e; chosen with max_log_nfa = -2 in mind,
which gives 0.33."""
CLIP = 3.0
"""Noises beyond which a displacement counts no more: three standard deviations, so that no match decides."""
NOISE_DISPARITY = 1.6651
"""Median displacement by noise alone: 2 sqrt(ln 2), the median sqrt(2 ln 2) of a Rayleigh variable for the
difference of two bearings, sqrt(2) noises per axis."""

NEAR_QUANTILE, NEAR_SHARE = 0.8, 0.5
"""The nearest fifth of what agrees says how far two pictures lie apart where the rest is too far to move: in
a room half of what it exceeds is the median of all. Of pairs at most 1.5 m apart in a street and two yards
the median is 5.4 to 5.9 degrees a metre with an error of a factor of 1.7 to 3.5, the larger of both 7.9 to
8.5 with one of 1.6 to 1.8; in rooms 12.7 to 16.0 and 13.8 to 16.6."""


def disparity_rad(apart_rad: FloatArray) -> float:
    """How much bearings differ beside the rotation, radians: falls to zero where both pictures are taken.

    The median over the inliers; where most of them are far away (sky, the end of a street) what is near tells
    more, see NEAR_QUANTILE.

    Args:
        apart_rad: (N,) angles between the current bearings and the turned target ones, N >= 1.
    """
    return max(float(np.median(apart_rad)), NEAR_SHARE * quantile(apart_rad, NEAR_QUANTILE))


def quantile(values: FloatArray, share: float) -> float:
    """np.quantile(values, share), which takes ten times as long on so few."""
    place = share * (len(values) - 1)
    low = int(place)
    high = min(low + 1, len(values) - 1)
    ordered = np.sort(values)
    return float(ordered[low] + (place - low) * (ordered[high] - ordered[low]))


def noise_rad(residual: FloatArray, fitted: int = 2) -> float:
    """Standard deviation of inlier residuals (rad) after `fitted` parameters.

    Not the median: over a short baseline the fit picks the direction that makes the central residuals small,
    and the median then reads half of the true noise.
    """
    freedom = max(len(residual) - fitted, 1)
    return float(max(np.sqrt(np.sum(residual**2) / freedom), NOISE_FLOOR_RAD))


def log_nfa(inliers: int, count: int, chance: float, sample: int, tests: int) -> float:
    """Natural logarithm of the expected number of equally good models among wrong matches only.

    A-contrario test (Moisan and Stival 2004) with the Chernoff bound of the binomial tail:
    ln NFA <= ln tests - n KL(k/n || chance) for k = inliers - sample of n = count - sample.

    Args:
        inliers: matches explained.
        count: matches given.
        chance: probability that a wrong match fits the model, (0, 1).
        sample: matches that fix a hypothesis, which explain themselves.
        tests: hypotheses tried.
    """
    n, k = count - sample, inliers - sample
    if n <= 0 or k <= n * chance:
        return float(np.log(tests))
    share = k / n
    divergence = share * np.log(share / chance)
    if share < 1.0:
        divergence += (1.0 - share) * np.log((1.0 - share) / (1.0 - chance))
    return float(np.log(tests) - n * divergence)


def confidence(
    inliers: int, count: int, chance: float, log_alarms: float, heading_std_rad: float, sign_margin: float
) -> float:
    """Trust in a heading, [0, 1]: the product of four shares.

    evidence  1 - exp(ln NFA / 5): near 0 where chance could explain the inliers, 0.86 at ln NFA = -10;
    purity    share of the inliers left after those that chance adds, (count - inliers) chance / (1 - chance);
    precision 1 / (1 + (heading_std / 10 deg)^2);
    sign      the margin by which the parallax tells forwards from backwards.
    """
    evidence = 1.0 - np.exp(min(log_alarms, 0.0) / -SURE_LOG_NFA)
    stray = (count - inliers) * chance / (1.0 - chance)
    purity = np.clip(1.0 - stray / max(inliers, 1), 0.0, 1.0)
    precision = 1.0 / (1.0 + (heading_std_rad / PRECISE_RAD) ** 2)
    return float(np.clip(evidence * purity * precision * sign_margin, 0.0, 1.0))


def parallax_share(disparity_rad: float, noise_rad: float) -> float:
    """Share of the squared disparity that is parallax, [1e-3, 1].

    Noise enters the normal matrix as if it were parallax and would make a direction look sharp that rests on
    nothing.
    """
    noise_disparity = NOISE_DISPARITY * noise_rad
    return float(np.clip(1.0 - (noise_disparity / max(disparity_rad, 1e-12)) ** 2, 1e-3, 1.0))


def sign_margin(forward: FloatArray, weight: FloatArray, noise: float) -> float:
    """Net share of the evidence, clipped at three noises, that matches move away from the heading."""
    evidence = weight * np.clip(forward / (CLIP * noise), -1.0, 1.0)
    total = float(np.sum(np.abs(evidence)))
    return float(np.clip(np.sum(evidence) / max(total, 1e-9), 0.0, 1.0))


def parallax_z(forward: FloatArray, noise: float) -> float:
    """Evidence for any motion: without one, the normalised displacement has the deviation `noise`."""
    if len(forward) == 0:
        return 0.0
    return float(np.sum(np.clip(forward / noise, -CLIP, CLIP)) / np.sqrt(len(forward)))
