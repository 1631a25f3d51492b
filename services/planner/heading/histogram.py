"""Polar histogram switch between methods 1 and 4 (THESIS row 25, sections 6.1.2 to 6.1.4).

Method 1 is biased where the matches lie on one side: half a turn without any means method 4.
"""

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import FloatArray, wrap_rad

BINS = 18
"""Sectors of 20 degrees (section 6.1.2)."""

EMPTY_RUN = 9
"""Half of the sectors (section 6.1.2)."""


def polar_histogram(current: FloatArray, bins: int = BINS) -> npt.NDArray[np.intp]:
    """Matches per sector of the current frame, (bins,); sector 0 starts at the seam, longitude -pi."""
    turn = (wrap_rad(current[:, 0]) + np.pi) / (2.0 * np.pi)
    upper = turn * bins + 1e-9  # an angle on an edge belongs to the upper bin
    index = np.minimum(upper.astype(np.intp), bins - 1)
    return np.bincount(index, minlength=bins)


def longest_empty_run(counts: npt.NDArray[np.intp]) -> int:
    """Length of the longest circular run of empty sectors."""
    empty = counts == 0
    if empty.all():
        return len(counts)
    start = int(np.argmin(empty))
    longest = run = 0
    for value in np.roll(empty, -start):
        run = run + 1 if value else 0
        longest = max(longest, run)
    return longest


def method_by_histogram(current: FloatArray, bins: int = BINS, empty_run: int = EMPTY_RUN) -> str:
    """'4' where at least `empty_run` neighbouring sectors hold no match, else '1'."""
    return "4" if longest_empty_run(polar_histogram(current, bins)) >= empty_run else "1"
