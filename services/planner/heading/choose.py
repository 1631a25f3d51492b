"""Which method gives the heading of this step, and why."""

from dataclasses import dataclass

import numpy.typing as npt
from pydantic import BaseModel, ConfigDict, Field

from services.planner.heading.combine import Combination
from services.planner.heading.epipolar import epipolar
from services.planner.heading.estimate import NO_HEADING, HeadingEstimate
from services.planner.heading.histogram import longest_empty_run, method_by_histogram, polar_histogram
from services.planner.heading.registry import MethodName, heading_method
from services.planner.heading.weights import WeightSettings
from shared.geometry.angles import FloatArray
from shared.geometry.two_view_types import TwoViewResult, checked_matches


class HeadingSettings(BaseModel):
    """Choice of the heading method.

    Attributes:
        method: the method asked for; 'epipolar' falls back to 'histogram' where two-view geometry has no
            answer.
        weight: weight function of methods 2, 4, 5 and 6.
        combination: how methods 5 and 6 add their parts.
        min_confidence: below it a two-view heading is not used.
        verified_only: feed methods 1 to 6 only the matches that two-view geometry verified, where it did.
        min_matches: fewer matches than this give no heading (Q10 has 40 as the thesis's trust floor).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    method: MethodName = "epipolar"
    weight: WeightSettings = WeightSettings()
    combination: Combination = "raw"
    min_confidence: float = Field(default=0.3, ge=0.0, le=1.0)
    verified_only: bool = True
    min_matches: int = Field(default=3, ge=1)


@dataclass(frozen=True)
class HeadingChoice:
    """The heading of one step.

    Attributes:
        method: the method that gave it: 'epipolar' or '1' to '6'.
        estimate: heading and strength; its heading is None where there is none to follow.
        reason: one sentence for the log and the console.
    """

    method: str
    estimate: HeadingEstimate
    reason: str


def choose_heading(
    settings: HeadingSettings, current: npt.ArrayLike, target: npt.ArrayLike, two_view: TwoViewResult | None
) -> HeadingChoice:
    """Heading by the configured method.

    Args:
        settings: the configured choice.
        current: (N, 2) longitude, latitude of all matches, current frame, radians.
        target: (N, 2) the same matches in the target frame.
        two_view: the result for exactly these matches, or None where it was not computed.
    """
    c, t = checked_matches(current, target)
    if settings.method == "epipolar":
        return _epipolar_or_fallback(settings, c, t, two_view)
    c, t, how = _verified(settings, c, t, two_view)
    return _by_matches(settings, settings.method, c, t, f"configured, {how}")


def _epipolar_or_fallback(
    settings: HeadingSettings, c: FloatArray, t: FloatArray, two_view: TwoViewResult | None
) -> HeadingChoice:
    if two_view is None:
        return _by_matches(settings, "histogram", c, t, "no two-view result")
    if two_view.status == "no_baseline":
        why = f"only turned: {two_view.inliers} of {len(c)} matches fit a rotation, so no direction exists"
        return HeadingChoice("epipolar", NO_HEADING, why)
    if two_view.usable and two_view.confidence >= settings.min_confidence:
        why = (
            f"two-view: {two_view.inliers} of {len(c)} matches verified, confidence {two_view.confidence:.2f}"
        )
        return HeadingChoice("epipolar", epipolar(two_view), why)
    what = f"confidence {two_view.confidence:.2f} too low" if two_view.usable else two_view.status
    c, t, how = _verified(settings, c, t, two_view)
    return _by_matches(settings, "histogram", c, t, f"two-view {what}, {how}")


def _verified(
    settings: HeadingSettings, c: FloatArray, t: FloatArray, two_view: TwoViewResult | None
) -> tuple[FloatArray, FloatArray, str]:
    """The verified matches where there are any, else all, and words for it."""
    if not settings.verified_only or two_view is None or two_view.status not in ("ok", "no_baseline"):
        return c, t, f"all {len(c)} matches"
    if len(two_view.inlier_mask) != len(c):
        raise ValueError(
            f"two_view must belong to these {len(c)} matches, its mask has {len(two_view.inlier_mask)}: "
            "pass the matches it was computed from"
        )
    return c[two_view.inlier_mask], t[two_view.inlier_mask], f"{two_view.inliers} verified matches"


def _by_matches(
    settings: HeadingSettings, name: str, c: FloatArray, t: FloatArray, why: str
) -> HeadingChoice:
    method = name
    if name == "histogram":
        method = method_by_histogram(c)
        empty = longest_empty_run(polar_histogram(c))
        why += f"; {empty} neighbouring sectors of 18 empty, so method {method}"
    if len(c) < settings.min_matches:
        return HeadingChoice(method, NO_HEADING, f"{why}; {len(c)} matches, {settings.min_matches} needed")
    estimate = heading_method(method, settings.weight, settings.combination)(c, t, None)
    return HeadingChoice(
        method, estimate, why if estimate.heading_rad is not None else f"{why}; the matches cancel out"
    )
