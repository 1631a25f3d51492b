"""Heading by two-view geometry: the direction of travel that the verified matches agree on (THESIS 1c)."""

from services.planner.heading.estimate import NO_HEADING, HeadingEstimate
from shared.geometry.two_view_types import TwoViewResult


def epipolar(result: TwoViewResult | None) -> HeadingEstimate:
    """Heading of a two-view result, with its confidence as strength; none where it has no usable answer."""
    if result is None or not result.usable or result.heading_rad is None:
        return NO_HEADING
    return HeadingEstimate(result.heading_rad, result.confidence)
