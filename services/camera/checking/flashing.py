"""How late pictures come, by a screen that turns bright and dark before the camera. Pure.

A picture shows the screen as it was when the picture was exposed. Of all delays that one is right by which
the brightness of some part of the pictures follows the screen best.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

SHORTEST_S, LONGEST_S = 0.4, 1.2
"""Between two changes, drawn evenly; chosen: longer than a picture takes, and never the same twice."""
MOST_DELAY_S = 3.0
"""Chosen: a robot cannot be driven by older pictures."""
STEP_S = 0.01
FEWEST_CHANGES = 6
"""That pictures must show; chosen: noise in 2048 parts follows three of them now and then."""
LEAST_LEVELS = 2.0
"""Standard deviation, of 255, of a part that shows the screen; chosen: several times that of noise."""
LEAST = 0.8
"""Correlation from which a part of the picture is the screen; chosen: moving people stay below 0.5."""
EVEN = 0.98
"""Delays that are this near to the best one are as good: between two pictures nothing tells them apart."""


@dataclass(frozen=True)
class Change:
    """The screen turned bright, or dark, at a time in seconds."""

    at_s: float
    bright: bool


def next_change_s(rng: np.random.Generator) -> float:
    """How long the screen stays as it is."""
    return float(rng.uniform(SHORTEST_S, LONGEST_S))


def delay_of(changes: Sequence[Change], arrivals_s: Sequence[float], parts: FloatArray) -> float | None:
    """Delay from exposure to arrival, seconds; None where no part of the pictures follows the screen.

    Args:
        changes: of the screen, in order, on the clock of the arrivals.
        arrivals_s: when each of N pictures came.
        parts: brightness (N, P) of the parts of each picture.
    """
    if len(changes) < FEWEST_CHANGES:
        return None
    delays = np.arange(0.0, MOST_DELAY_S, STEP_S)
    scores = np.array([_score(changes, np.asarray(arrivals_s) - delay, parts) for delay in delays])
    best = int(np.argmax(scores))
    if scores[best] < LEAST:
        return None
    even = np.abs(scores) >= EVEN * scores[best]
    first = last = best
    while first > 0 and even[first - 1]:
        first -= 1
    while last + 1 < len(even) and even[last + 1]:
        last += 1
    return float(delays[first] + delays[last]) / 2.0


def _score(changes: Sequence[Change], exposed_s: FloatArray, parts: FloatArray) -> float:
    """Correlation of the part that follows the screen best, if pictures were exposed then."""
    times = [change.at_s for change in changes]
    places = np.array([bisect_right(times, at_s) - 1 for at_s in exposed_s])
    known = places >= 0
    if not known.any() or places.max() - places[known].min() < FEWEST_CHANGES:
        return 0.0
    screen = np.array([1.0 if changes[place].bright else 0.0 for place in places[known]])
    seen = parts[known]
    screen = screen - screen.mean()
    seen = seen - seen.mean(axis=0)
    spread = np.linalg.norm(seen, axis=0)
    changes_much = spread > LEAST_LEVELS * math.sqrt(len(screen))
    found = np.divide(screen @ seen, spread, out=np.zeros(seen.shape[1]), where=changes_much)
    return float(found.max(initial=0.0) / np.linalg.norm(screen))
