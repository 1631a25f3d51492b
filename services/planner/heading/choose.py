"""Which method gives the heading towards a matched view, and why.

Two-view geometry gives it where its answer is trusted: the direction of travel that the inliers agree on
(decision 0003). Where it has none there is no heading: votes of matches that agree on no motion were 54
degrees off on photographs, 29 % of them backwards. One of the thesis's methods 1 to 6 is taken where a
profile says so; which one of 1 and 4 the polar histogram of the matches tells (sections 6.1.2 to 6.1.4).
"""

from dataclasses import dataclass

import numpy.typing as npt

from services.planner.heading.estimate import NO_HEADING, HeadingEstimate
from services.planner.heading.histogram import longest_empty_run, method_by_histogram, polar_histogram
from services.planner.heading.methods import HISTOGRAM, MethodName, heading_estimate
from shared.geometry.two_view_types import checked_matches
from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.3
"""Below it a two-view heading is not used; chosen: an edge asks for 0.5, a heading lasts for one frame."""

MATCHES_MIN = 3
"""Fewer matches give no heading; chosen: any two longitudes have a bisector. Q10's 40 is a floor of trust."""


@dataclass(frozen=True)
class HeadingChoice:
    """The heading of one step.

    Attributes:
        method: the method that gave it: 'epipolar' or '1' to '6'.
        estimate: heading and strength; its heading is None where there is none to follow.
        reason: one sentence for people.
    """

    method: str
    estimate: HeadingEstimate
    reason: str


def choose_heading(match: NodeMatch, method: MethodName, *, verified_only: bool = True) -> HeadingChoice:
    """Heading from the frame to a matched view.

    Args:
        match: how the frame relates to the view.
        method: the profile's.
        verified_only: give methods 1 to 6 only the inliers, where there are any.
    """
    if match.status == "no_baseline":
        why = f"only turned: {match.inliers} of {match.raw_matches} matches fit a rotation"
        return HeadingChoice("epipolar", NO_HEADING, why)
    agree = f"{match.inliers} of {match.raw_matches} matches verified, confidence {match.confidence:.2f}"
    if method == "epipolar":
        if match.status == "ok" and match.confidence >= CONFIDENCE_MIN:
            estimate = HeadingEstimate(match.heading_rad, match.confidence)
            return HeadingChoice("epipolar", estimate, f"two-view: {agree}")
        return HeadingChoice("epipolar", NO_HEADING, f"two-view {match.status}, {agree}")
    why = f"configured, {agree}"
    if match.matches_rad is None or match.inlier_mask is None:
        return HeadingChoice(method, NO_HEADING, f"{why}; the matches were not sent")
    pairs = match.matches_rad
    if verified_only and match.status == "ok":
        pairs = pairs[match.inlier_mask.astype(bool)]
    return heading_by_votes(method, pairs[:, :2], pairs[:, 2:], why)


def heading_by_votes(method: str, current: npt.ArrayLike, target: npt.ArrayLike, why: str) -> HeadingChoice:
    """Heading by the histogram's choice or by one of methods 1 to 6.

    Args:
        method: "histogram" or "1" to "6".
        current: (N, 2) longitude, latitude of matches, current frame, radians.
        target: (N, 2) the same matches in the target frame.
        why: first part of the reason.
    """
    c, t = checked_matches(current, target)
    if method == HISTOGRAM:
        method = method_by_histogram(c)
        empty = longest_empty_run(polar_histogram(c))
        why += f"; {empty} neighbouring sectors of 18 empty, so method {method}"
    if len(c) < MATCHES_MIN:
        return HeadingChoice(method, NO_HEADING, f"{why}; {len(c)} matches, {MATCHES_MIN} needed")
    estimate = heading_estimate(method, c, t)
    lost = "" if estimate.heading_rad is not None else "; the matches cancel out"
    return HeadingChoice(method, estimate, why + lost)
