"""Reading a match: similarity, trust, and the heading it gives."""

from services.planner.heading.choose import choose_heading
from services.planner.ports import Matches
from services.planner.profiles import Profile
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import openness
from shared.messages.matching import NodeMatch

CLOSE = 2.0
"""A view that resembles a node by more than so many times rule 4.2's bound is that of the node itself: of
pairs 0.3 to 0.5 m apart nine in ten have at most 151 inliers (`topnav calibrate`), so 180 means nearer."""
OPEN_POWER = 2.0
"""How the matches of a near view grow with how far views carry; chosen: 22 in a room, 80 in a street."""


def similarity(match: NodeMatch, profile: Profile) -> int:
    """S of two frames: verified matches, or raw ones under the thesis's rules."""
    return match.inliers if profile.sensing.similarity == "verified" else match.raw_matches


def trusted(match: NodeMatch, profile: Profile) -> bool:
    """Whether the two-view geometry of this match may become an edge or be driven along."""
    if match.status == "no_baseline":
        return True
    return (
        match.status == "ok"
        and match.heading_rad is not None
        and match.yaw_rad is not None
        and match.heading_std_rad is not None
        and match.heading_std_rad < profile.sensing.heading_std_max_rad
    )


def tells_place(match: NodeMatch, graph: MapGraph, profile: Profile) -> bool:
    """Whether a match says where its node is.

    Bearings that do not change mean this very spot where many agree, else that both see what is far away.
    """
    return trusted(match, profile) and (match.status != "no_baseline" or close_enough(match, graph, profile))


def close_enough(match: NodeMatch, graph: MapGraph, profile: Profile) -> bool:
    """Whether so many matches agree that a small disparity means near: in the open far things agree, too."""
    least = profile.travel.s_via_min * openness(graph, match.node_id) ** OPEN_POWER
    return bool(similarity(match, profile) >= min(least, CLOSE * profile.mapping.s_node_max))


def ranked(matches: Matches, profile: Profile) -> list[tuple[int, NodeMatch]]:
    """Node ids and matches, most similar first, ties by id."""
    return sorted(matches.items(), key=lambda item: (-similarity(item[1], profile), item[0]))


def heading_of(match: NodeMatch, profile: Profile) -> tuple[float, str] | None:
    """Heading to the matched node by the profile's method, and the method used; None when there is none."""
    verified = profile.sensing.similarity == "verified"
    choice = choose_heading(match, profile.sensing.heading_method, verified_only=verified)
    heading_rad = choice.estimate.heading_rad
    return (heading_rad, choice.method) if heading_rad is not None else None
