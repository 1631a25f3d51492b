"""Thresholds and rules that belong together, by name.

The thesis's 60 / 80 / 90 / 110 of 150 are bound to SuperPoint and SuperGlue; other pipelines have their own.
`topnav calibrate` measures the ones that depend on the pipeline and the kind of place. S is the similarity of
two frames; figures of S and disparity by distance are those of `topnav calibrate` (500 pairs of the
apartment, seed 1) and, outdoors, those below.
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
        disparity_rad_per_m: how fast bearings change with distance in this kind of place.
        similarity_m: a node is at least this over S away, metres: where most of what is seen is far off,
            small disparity alone does not mean near. 0 leaves it out.
        unsure_m: a node with S below s_sure may be this over S away, metres: it gets no edge unless ground up
            to there is seen free. 0 leaves it out.
        robot_radius_m: of the disc that must fit along an edge; robot_slim_m: through a gap.
        opening_m: free way that makes a direction open; blocked_m: too little to go on.
        doorway_m: free way beyond which an opening beside the way is worth a node of its own; 0: no doors.
    """

    similarity: Literal["verified", "raw"] = "verified"
    heading_method: MethodName = "epipolar"
    heading_std_max_rad: PositiveFloat = math.radians(6.0)  # off by the robot's radius after 3 m
    disparity_rad_per_m: PositiveFloat = math.radians(9.0)  # 15.6 degrees at 1.75 m: `topnav calibrate`
    similarity_m: float = Field(default=0.0, ge=0.0)
    unsure_m: float = Field(default=0.0, ge=0.0)
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
        share_min: share of the raw matches that must be inliers for an edge with S below s_sure, or without
            free ground seen. The edge to the node the robot came from needs no more than s_edge_min.
        noise_max_rad: an edge's matches spread less about its motion: in another room of the same kind things
            stand a little differently. 0 leaves it out.
        blur_max: ... and by less than this share of its disparity: who stands nearly there sees nearly the
            same. 0 leaves it out.
        moved_min: an edge's matches whose bearing changed beside the camera's turn are at least so many: far
            things look alike from many places. 0 leaves it out.
        s_blind_min: S of an edge along which no free ground was seen.
        far_rad: with less disparity than this an edge needs s_sure: few matches that hardly move are far
            away, and so may the node be.
        s_far: an edge to a far part of the map needs so many inliers: among equal houses fewer prove nothing.
        node_apart_m: a node lies at least so far from those seen from it, unless it is needed as a corner or
            doorway: where things repeat views change within a few decimetres. 0: similarity alone decides.
        edge_longest_m: of an edge; shorter ones lead there, and longer ones were views past a corner. 0: any.
        edge_candidates: most nodes compared for edges of a new one.
        edge_window: so many of the newest nodes may get an edge instead; 0: the most similar of all.
        explored: which directions an edge covers.
        covers_m: floor this near to a node needs no other one; 0: every open direction is explored.
        gain_min: share of the floor around a spot that must be new for a direction to be explored.
        departure_steps: steps in an unexplored direction after which nothing new is to be expected there.
        saturation_steps: frames without anything known before the robot turns back (Q17).
        exploration_noise_rad, admissible_noise_rad: half widths of the strategies' random headings (Q18).
    """

    exploration: Literal["frontier", "strategies"] = "frontier"
    s_edge_min: PositiveInt = 30  # s_via_min times the thesis's 80/60 (section 6.1): `topnav calibrate`
    s_node_max: PositiveInt = 90  # median S at 0.5 to 0.9 m, where nodes should be: `topnav calibrate`
    s_sure: PositiveInt = 45  # medians are 57 at 1 to 1.5 m, 38 beyond: `topnav calibrate`
    share_min: float = Field(default=0.0, ge=0.0, le=1.0)
    noise_max_rad: float = Field(default=0.0, ge=0.0)
    blur_max: float = Field(default=0.0, ge=0.0)
    moved_min: NonNegativeInt = 0
    s_blind_min: NonNegativeInt = 0
    far_rad: float = Field(default=0.0, ge=0.0)
    s_far: NonNegativeInt = 0
    node_apart_m: float = Field(default=0.5, ge=0.0)  # the least that `topnav calibrate` asks about
    edge_longest_m: float = Field(default=3.0, ge=0.0)  # of 3,600 right edges of two worlds none had 3 m
    edge_candidates: PositiveInt = (
        12  # nodes of the apartment's map have 8 edges on average: `topnav explore`
    )
    edge_window: NonNegativeInt = 0
    explored: ExploredRules = ExploredRules()
    covers_m: float = Field(default=1.0, ge=0.0)
    gain_min: float = Field(default=0.1, ge=0.0, le=1.0)
    departure_steps: PositiveInt = 18  # 2.2 m at 0.12 m a step; the median S is below s_node_max after 1 m
    saturation_steps: PositiveInt = 5  # reading Q17 (decision 0012)
    exploration_noise_rad: float = math.radians(50.0)  # the thesis's 50, read as degrees (Q18)
    admissible_noise_rad: float = math.radians(90.0)  # thesis section 4.2


class TravelRules(_Rules):
    """Paths, waypoints and speed.

    Attributes:
        path_cost: "disparity" or the thesis's "nodes".
        s_via_min, s_via_max: thresholds of equation 4.3.
        suspend_after: frames in a row without the waypoint before it counts as lost.
        delete_edges: an edge that failed is deleted for good (equation 6.4) instead of suspended.
        s_slow, s_max: of the velocity law, equation 6.5.
    """

    path_cost: Literal["disparity", "nodes"] = "disparity"
    s_via_min: PositiveInt = 22  # no bearing of a pair with more was wrong by 20 degrees: `topnav calibrate`
    s_via_max: PositiveInt = 100  # of the strict rule 4.3 only; by disparity otherwise
    suspend_after: PositiveInt = 5  # reading Q12 (decision 0012)
    delete_edges: bool = False
    s_slow: PositiveInt = 150  # half of s_max, where the thesis has 90 of 150 (equation 6.5)
    s_max: PositiveInt = 300  # keypoints of the default pipeline


class ArrivalRules(_Rules):
    """When the end of a path is reached.

    Attributes:
        arrival_rad: disparity at which a goal picture's spot is reached; 0 uses s_final.
        travel_arrival_rad: the same for a waypoint or a node to explore from.
        near_rad, s_near: with less disparity and more S the robot may stop where obstacles end its way.
        s_final: S that ends a mission by count alone.
    """

    arrival_rad: float = Field(
        default=math.radians(1.0), ge=0.0
    )  # ends 4 cm from the goal: `topnav hide-and-seek --rounds 20`
    travel_arrival_rad: PositiveFloat = math.radians(3.5)  # 0.35 m by disparity_rad_per_m
    near_rad: PositiveFloat = math.radians(4.0)  # 0.44 m by disparity_rad_per_m: a goal beside furniture
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
    heading_method="histogram",
    exploration="strategies",
    covers_m=0.0,
    path_cost="nodes",
    suspend_after=1,
    delete_edges=True,
    arrival_rad=0.0,
)

# From 120 pairs of village frames, 500 keypoints (`topnav calibrate --world village`): S 144 at 1 to 2 m, 78
# at 2 to 3, 48 at 3 to 4, 40 at 4 to 6, 30 at 6 to 10; 3 degrees of disparity per metre within 2 m, half of
# that at 4; no bearing with more than 22 inliers was wrong.
OUTDOOR_SPACE = {
    "opening_m": 4.0,  # chosen: twice the spacing of nodes, so that a yard is not full of frontiers
    "blocked_m": 0.4,  # chosen: the body's radius and 15 cm, for hedges
    "doorway_m": 0.0,
    "departure_steps": 40,  # 16 m at 0.4 m a step
    "disparity_rad_per_m": math.radians(2.2),  # between 3 within 2 m and 1.5 at 4 m
}

OUTDOOR = DEFAULT.replaced(
    name="outdoor",
    covers_m=0.0,
    **OUTDOOR_SPACE,
    s_edge_min=25,  # above the 22 of wrong bearings
    s_node_max=100,  # between 144 at 1 to 2 m and 78 at 2 to 3: nodes 2 m apart recognise each other
    node_apart_m=0.0,
    edge_longest_m=0.0,
    s_explored=28,  # 30 at 6 to 10 m: one edge covers a wide sector
    s_via_min=16,
    s_via_max=120,
    share_min=0.5,  # of 238 edges without free ground two had less, one of them wrong
    edge_candidates=30,  # chosen: views reach further, so more nodes resemble a frame
    explored_half_rad=math.radians(60.0),
    near_half_rad=math.radians(75.0),
    blind_half_rad=math.radians(30.0),
    arrival_rad=math.radians(0.6),  # 0.2 m at 3 degrees a metre
    travel_arrival_rad=math.radians(2.5),  # 0.8 m
    near_rad=math.radians(2.0),  # 0.7 m
    s_near=240,  # half of the 500 keypoints
    robot_radius_m=0.35,
    robot_slim_m=0.3,
    similarity_m=300.0,  # S times distance is 195 at 2.5 m, 200 at 5, 240 at 8; and half as much again
    unsure_m=750.0,  # chosen: 25 m at 30 inliers, 2.5 times similarity_m: the tail, not the median
    s_blind_min=60,  # above the 48 of 3 to 4 m: only nodes nearer than that
    far_rad=math.radians(3.5),  # 1.6 m by disparity_rad_per_m
    s_far=110,  # above the 106 of the most similar wrong edge (decision 0015)
)
"""Streets and yards, with 500 keypoints: nodes are 2 m apart."""

THESIS_OUTDOOR = THESIS.replaced(name="thesis_outdoor", heading_method="4", **OUTDOOR_SPACE)
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

PROFILES = {profile.name: profile for profile in (DEFAULT, OUTDOOR, THESIS, THESIS_OUTDOOR, PHOTO)}


def profile_named(name: str) -> Profile:
    """Return the profile or raise ValueError listing the choices."""
    if name not in PROFILES:
        raise ValueError(f"planner profile must be one of {sorted(PROFILES)}, got {name!r}")
    return PROFILES[name]
