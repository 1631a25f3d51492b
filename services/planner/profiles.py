"""Thresholds and rules that belong together, by name.

The thesis's 60 / 80 / 90 / 110 of 150 are bound to SuperPoint and SuperGlue; other pipelines have their own,
which `topnav calibrate` measures. S is the similarity of two frames; figures of S by distance are those of
`topnav calibrate` (500 pairs of the apartment, seed 1). Lengths and angles are those of a room: how many
times further views carry elsewhere the robot learns from what it drives (`shared.mapgraph.local.view_range`).
"""

import math
from collections.abc import Mapping
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeInt, PositiveFloat, PositiveInt

from services.planner.heading.methods import MethodName
from shared.mapgraph.frontiers import ExploredRules


class _Rules(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class SensingRules(_Rules):
    """What a match and a distance are worth.

    Attributes:
        similarity: S counts inliers ("verified") or raw matches (thesis).
        heading_method: a name of `services.planner.heading.methods`.
        heading_std_max_rad: a heading less certain than this is not driven along.
        robot_radius_m: of the disc that must fit along an edge; robot_slim_m: through a gap.
        opening_m: free way that makes a direction open; blocked_m: too little to go on.
        doorway_m: free way beyond which an opening beside the way is worth a node of its own; 0: no doors.
    """

    similarity: Literal["verified", "raw"] = "verified"
    heading_method: MethodName = "epipolar"
    heading_std_max_rad: PositiveFloat = math.radians(6.0)  # off by the robot's radius after 3 m
    robot_radius_m: PositiveFloat = 0.3  # the simulator's body, 0.25 m, and 5 cm to spare
    robot_slim_m: PositiveFloat = 0.27  # the body and 2 cm: gaps are driven slowly
    opening_m: PositiveFloat = 0.55  # twice the body's radius and 5 cm (decision 0004)
    blocked_m: PositiveFloat = 0.25  # the body's radius
    doorway_m: float = Field(default=1.0, ge=0.0)  # deeper than niches and the room under desks


class MappingRules(_Rules):
    """Which frames become nodes, and which edges they get.

    Attributes:
        exploration: "frontier" or the thesis's "strategies".
        s_edge_min, s_node_max: map thresholds of equations 4.1 and 4.2.
        s_sure: S from which an edge needs no further proof.
        noise_max_rad: an edge's matches spread less about its motion: in another room of the same kind things
            stand a little differently. 0 leaves it out.
        blur_max: ... and by less than this share of its disparity: who stands nearly there sees nearly the
            same. 0 leaves it out.
        moved_min: an edge's matches whose bearing changed beside the camera's turn are at least so many: far
            things look alike from many places. 0 leaves it out.
        far_rad: with less disparity than this an edge needs s_sure: few matches that hardly move are far
            away, and so may the node be.
        node_apart_m: a node lies at least so far from those seen from it, unless it is needed as a corner or
            doorway: where things repeat views change within a few decimetres. 0: similarity alone decides.
        edge_longest_m: of an edge in a room; longer ones were views past a corner. 0: any.
        edge_candidates: most nodes compared for edges of a new one.
        edge_window: so many of the newest nodes may get an edge instead; 0: the most similar of all.
        explored: which directions an edge covers.
        covers_m: floor this near to a node needs no other one; None: 1 m in a room, further where views carry
            further; 0: every open direction is explored.
        gain_min: share of the floor around a spot that must be new for a direction to be explored, in a room;
            where nodes cover more than a metre, less by the root of that.
        departure_m: way in an unexplored direction of a room after which nothing new is to be expected there.
        saturation_steps: frames without anything known before the robot turns back (Q17).
        exploration_noise_rad, admissible_noise_rad: half widths of the strategies' random headings (Q18).
    """

    exploration: Literal["frontier", "strategies"] = "frontier"
    s_edge_min: PositiveInt = 30  # s_via_min times the thesis's 80/60 (section 6.1): `topnav calibrate`
    s_node_max: PositiveInt = 90  # median S at 0.5 to 0.9 m, where nodes should be: `topnav calibrate`
    s_sure: PositiveInt = 45  # medians are 57 at 1 to 1.5 m, 38 beyond: `topnav calibrate`
    noise_max_rad: float = Field(default=0.0, ge=0.0)
    blur_max: float = Field(default=0.0, ge=0.0)
    moved_min: NonNegativeInt = 0
    far_rad: float = Field(default=0.0, ge=0.0)
    node_apart_m: float = Field(default=0.5, ge=0.0)  # the least that `topnav calibrate` asks about
    edge_longest_m: float = Field(default=3.0, ge=0.0)  # of 3,600 right edges of two worlds none had 3 m
    edge_candidates: PositiveInt = (
        12  # nodes of the apartment's map have 8 edges on average: `topnav explore`
    )
    edge_window: NonNegativeInt = 0
    explored: ExploredRules = ExploredRules()
    covers_m: float | None = Field(default=None, ge=0.0)
    gain_min: float = Field(default=0.15, ge=0.0, le=1.0)
    departure_m: PositiveFloat = 2.2  # the median S is below s_node_max after 1 m
    saturation_steps: PositiveInt = 5  # reading Q17 (decision 0012)
    exploration_noise_rad: float = math.radians(50.0)  # the thesis's 50, read as degrees (Q18)
    admissible_noise_rad: float = math.radians(90.0)  # thesis section 4.2


class TravelRules(_Rules):
    """Paths, waypoints and speed.

    Attributes:
        path_cost: "length" or the thesis's "nodes".
        s_via_min, s_via_max: thresholds of equation 4.3.
        suspend_after: frames in a row without the waypoint before it counts as lost.
        delete_edges: an edge that failed is deleted for good (equation 6.4) instead of suspended.
        s_slow, s_max: of the velocity law, equation 6.5.
        room_speed: share of the full speed in a room; more where views carry further.
    """

    path_cost: Literal["length", "nodes"] = "length"
    s_via_min: PositiveInt = 22  # no bearing of a pair with more was wrong by 20 degrees: `topnav calibrate`
    s_via_max: PositiveInt = 100  # of the strict rule 4.3 only; by disparity otherwise
    suspend_after: PositiveInt = 5  # reading Q12 (decision 0012)
    delete_edges: bool = False
    s_slow: PositiveInt = 150  # half of s_max, where the thesis has 90 of 150 (equation 6.5)
    s_max: PositiveInt = 300  # keypoints of the default pipeline
    room_speed: float = Field(default=0.5, gt=0.0, le=1.0)  # section 6.2 of the thesis: 5 of 10 rad/s indoors


class ArrivalRules(_Rules):
    """When the end of a path is reached.

    Attributes:
        arrival_rad: disparity at which a goal picture's spot is reached in a room; 0 uses s_final.
        travel_arrival_rad: the same for a waypoint or a node to explore from.
        near_rad, s_near: with less disparity and more S the robot may stop where obstacles end its way.
        s_final: S that ends a mission by count alone.
    """

    arrival_rad: float = Field(
        default=math.radians(1.0), ge=0.0
    )  # ends 4 cm from the goal: `topnav hide-and-seek --rounds 20`
    travel_arrival_rad: PositiveFloat = math.radians(3.5)  # 0.4 m at 9 degrees a metre
    near_rad: PositiveFloat = math.radians(4.0)  # 0.44 m at 9 degrees a metre: a goal beside furniture
    s_near: PositiveInt = 100  # the median at 0.5 to 1 m is 87: `topnav calibrate`
    s_final: PositiveInt = 1_000_000  # never: arrival is by disparity


class Profile(_Rules):
    """How the planner decides."""

    name: str
    sensing: SensingRules = SensingRules()
    mapping: MappingRules = MappingRules()
    travel: TravelRules = TravelRules()
    arrival: ArrivalRules = ArrivalRules()

    def replaced(self, **changes: Any) -> "Profile":
        """The same rules with other values of some fields, wherever they stand: names are unique.

        Raises:
            ValueError: no such field, or a value it refuses.
        """
        return Profile.model_validate(_replaced(self.model_dump(), changes))


def _replaced(values: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The nested values with the changes in their places; what has no place is left on top, to be refused."""
    left = dict(changes)
    result = {name: left.pop(name, value) for name, value in values.items()}
    for name, value in result.items():
        if isinstance(value, dict):
            inside = {key: left.pop(key) for key in list(left) if key in _names(value)}
            result[name] = _replaced(value, inside)
    return result | left


def _names(values: Mapping[str, Any]) -> set[str]:
    return {
        name
        for key, value in values.items()
        for name in (_names(value) if isinstance(value, dict) else {key})
    }


DEFAULT = Profile(name="default")

THESIS = DEFAULT.replaced(
    name="thesis",
    similarity="raw",
    # 80 and 110, 60 and 90, 110 of 150 for SuperPoint (Q9); these are for raw matches of 300 SIFT keypoints.
    s_edge_min=40,
    s_node_max=90,
    node_apart_m=0.0,
    s_explored=60,
    s_via_min=30,
    s_via_max=85,
    s_final=105,
    s_slow=85,
    s_max=150,
    room_speed=1.0,
    heading_method="histogram",
    exploration="strategies",
    covers_m=0.0,
    path_cost="nodes",
    suspend_after=1,
    delete_edges=True,
    arrival_rad=0.0,
)

THESIS_OUTDOOR = THESIS.replaced(name="thesis_outdoor", heading_method="4")
"""The thesis's rules in its village: method 4 (section 4.3)."""

PHOTO = DEFAULT.replaced(
    name="photo",
    s_edge_min=34,
    noise_max_rad=math.radians(0.52),  # of equal rooms 0.56 and more, or a quarter of the disparity
    blur_max=0.15,
    node_apart_m=0.0,
    edge_longest_m=0.0,
    moved_min=30,  # all but the view out of the window
    far_rad=math.radians(7.0),  # who stands that near shares more: links 50 to 400
    s_sure=50,
    s_node_max=250,  # of 1000 keypoints: as 90 of 300, less for the ratio of 0.95
    s_via_min=30,
    s_near=250,
    s_slow=500,
    s_max=1000,
)
"""For pipeline photo: real cameras that lean, 1.5 to 5 m from one picture to the next."""

PHOTO_TOPNAV = PHOTO.replaced(
    name="photo_topnav",
    s_edge_min=92,  # above all of other bedrooms in a flat of the development split (deploy/TRAINING.md)
)
"""For pipeline photo_topnav, whose descriptors find more alike."""

PROFILES = {profile.name: profile for profile in (DEFAULT, THESIS, THESIS_OUTDOOR, PHOTO, PHOTO_TOPNAV)}

OF_PIPELINES = (PHOTO.name, PHOTO_TOPNAV.name)
"""Those that go with the pipeline of the same name."""


def profile_name_for(pipeline: str, otherwise: str = DEFAULT.name) -> str:
    """Name of the profile that goes with a pipeline, `otherwise` where it has none of its own."""
    return pipeline if pipeline in OF_PIPELINES else otherwise


def profile_named(name: str) -> Profile:
    """Return the profile or raise ValueError listing the choices."""
    if name not in PROFILES:
        raise ValueError(f"planner profile must be one of {sorted(PROFILES)}, got {name!r}")
    return PROFILES[name]
