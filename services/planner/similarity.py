"""Reading a match: similarity, trust, and the heading it gives."""

from services.planner.heading.choose import HeadingSettings, choose_heading
from services.planner.profiles import Profile
from shared.messages.matching import NodeMatch

CLOSE = 2.0
"""A view that resembles a place by more than so many times rule 4.2's bound is that of the place itself."""


def similarity(match: NodeMatch, profile: Profile) -> int:
    """S of two frames: verified matches, or raw ones under the thesis's rules."""
    return match.inliers if profile.similarity == "verified" else match.raw_matches


def trusted(match: NodeMatch, profile: Profile) -> bool:
    """Whether the two-view geometry of this match may become an edge or be driven along."""
    if match.status == "no_baseline":
        return True
    return (
        match.status == "ok"
        and match.heading_rad is not None
        and match.yaw_rad is not None
        and match.heading_std_rad is not None
        and match.heading_std_rad < profile.heading_std_max_rad
    )


def apart_rad(disparity_rad: float, inliers: int, profile: Profile) -> float:
    """How far apart two views are as an angle: their disparity, or more where so few matches agree."""
    least_m = profile.similarity_m / max(inliers, 1)
    return max(disparity_rad, least_m * profile.disparity_rad_per_m)


def close_enough(match: NodeMatch, profile: Profile) -> bool:
    """Whether so many matches agree that a small disparity means near."""
    least = CLOSE * profile.s_node_max if profile.similarity_m else profile.s_via_min
    return similarity(match, profile) >= least


def ranked(matches: dict[int, NodeMatch], profile: Profile) -> list[tuple[int, NodeMatch]]:
    """Node ids and matches, most similar first, ties by id."""
    return sorted(matches.items(), key=lambda item: (-similarity(item[1], profile), item[0]))


def heading_of(match: NodeMatch, profile: Profile) -> tuple[float, str] | None:
    """Heading to the matched place by the profile's method, and the method used; None when there is none."""
    settings = HeadingSettings(method=profile.heading_method, verified_only=profile.similarity == "verified")
    if settings.method == "epipolar" and match.status == "ok" and match.confidence >= settings.min_confidence:
        return (match.heading_rad, "epipolar") if match.heading_rad is not None else None
    if match.matches_rad is None or match.inlier_mask is None or match.status == "no_baseline":
        return None
    pairs = match.matches_rad
    if settings.verified_only and match.status == "ok":
        pairs = pairs[match.inlier_mask.astype(bool)]
    choice = choose_heading(settings, pairs[:, :2], pairs[:, 2:], None)
    heading_rad = choice.estimate.heading_rad
    return (heading_rad, choice.method) if heading_rad is not None else None
