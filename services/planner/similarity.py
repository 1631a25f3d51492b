"""Reading a match: similarity, trust, and the heading it gives."""

from services.planner.heading.choose import choose_heading
from services.planner.profiles import Profile
from shared.messages.matching import NodeMatch


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


def ranked(matches: dict[int, NodeMatch], profile: Profile) -> list[tuple[int, NodeMatch]]:
    """Node ids and matches, most similar first, ties by id."""
    return sorted(matches.items(), key=lambda item: (-similarity(item[1], profile), item[0]))


def heading_of(match: NodeMatch, profile: Profile) -> tuple[float, str] | None:
    """Heading to the matched place by the profile's method, and the method used; None when there is none."""
    return choose_heading(match, profile.heading_method)
