"""Thresholds and rules that belong together, by name.

The thesis's 60 / 80 / 90 / 110 of 150 are bound to SuperPoint and SuperGlue; other pipelines have their own.
"""

import math
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeInt, PositiveFloat, PositiveInt

from services.planner.heading.registry import MethodName


class Profile(BaseModel):
    """How the planner decides.

    Attributes:
        similarity: S counts verified matches (inliers) or raw ones (thesis).
        s_edge_min, s_node_max: map thresholds of equations 4.1 and 4.2.
        s_sure: S from which an edge needs no further proof.
        share_min: share of the raw matches that must be verified for an edge with S below s_sure, or without
            free ground seen; look-alike places agree in less. The edge to the place the robot came from needs
            no more than s_edge_min.
        edge_window: so many of the newest places may get an edge to a new one; 0: the most similar of all.
        s_explored: an edge this similar leaves nothing unexplored in its direction.
        s_via_min, s_via_max: thresholds of equation 4.3; s_final ends a mission by count alone.
        s_slow, s_max: of the velocity law, equation 6.5.
        heading_method: a name of `services.planner.heading`.
        exploration: "frontier" or the thesis's "strategies".
        path_cost: "disparity" or the thesis's "nodes".
        suspend_after: bad frames in a row before an edge is given up; delete_edges: for good (equation 6.4).
        opening_m: free way that makes a direction worth exploring; blocked_m: too little to go on.
        doorway_m: free way beyond which an opening beside the way is a doorway, worth a place of its own; 0:
            there are no doors.
        edge_candidates: most places compared for edges of a new one.
        explored_half_rad: directions this near to that of an edge are explored; near_half_rad: for a place
            half as similar again.
        blind_half_rad: the same for an edge along which the sensors did not see free ground all the way.
        departure_steps: steps in an unexplored direction after which nothing new is to be expected there.
        disparity_rad_per_m: how fast bearings change with distance in this kind of place.
        similarity_m: a place is at least this over S away, metres: where most of what is seen is far off,
            small disparity alone does not mean near. 0 leaves it out.
        unsure_m: a place with S below s_sure may be this over S away, metres: it gets no edge unless ground
            up to there is seen free. 0 leaves it out.
        s_blind_min: S of an edge along which no free ground was seen.
        far_rad: with less disparity than this an edge needs s_sure matches: few matches that hardly move are
            far away, and so may the place be.
        arrival_rad: angular disparity at which a place is reached; 0 uses s_final.
        s_far: an edge to a far part of the map needs so many matches: among equal houses fewer prove nothing.
        near_rad, s_near: with less disparity and more S the robot may stop where obstacles end its way.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    similarity: Literal["verified", "raw"] = "verified"
    s_edge_min: PositiveInt = 30
    s_node_max: PositiveInt = 90
    share_min: float = Field(default=0.0, ge=0.0, le=1.0)
    s_sure: PositiveInt = 45
    edge_window: NonNegativeInt = 0
    edge_candidates: PositiveInt = 12
    explored_half_rad: PositiveFloat = math.radians(28.0)
    near_half_rad: PositiveFloat = math.radians(36.0)
    s_explored: PositiveInt = 45
    blind_half_rad: PositiveFloat = math.radians(36.0)
    s_via_min: PositiveInt = 22
    s_via_max: PositiveInt = 100
    s_final: PositiveInt = 1_000_000
    s_slow: PositiveInt = 150
    s_max: PositiveInt = 300
    heading_method: MethodName = "epipolar"
    exploration: Literal["frontier", "strategies"] = "frontier"
    path_cost: Literal["disparity", "nodes"] = "disparity"
    suspend_after: PositiveInt = 5
    delete_edges: bool = False
    arrival_rad: float = Field(default=math.radians(1.0), ge=0.0)
    travel_arrival_rad: PositiveFloat = math.radians(3.5)
    near_rad: PositiveFloat = math.radians(4.0)
    s_near: PositiveInt = 100
    heading_std_max_rad: PositiveFloat = math.radians(6.0)
    saturation_steps: PositiveInt = 5
    exploration_noise_rad: float = math.radians(50.0)
    admissible_noise_rad: float = math.radians(90.0)
    opening_m: PositiveFloat = 0.55
    blocked_m: PositiveFloat = 0.25
    doorway_m: float = Field(default=1.0, ge=0.0)
    departure_steps: PositiveInt = 18
    robot_radius_m: PositiveFloat = 0.3
    robot_slim_m: PositiveFloat = 0.27
    disparity_rad_per_m: PositiveFloat = math.radians(9.0)
    similarity_m: float = Field(default=0.0, ge=0.0)
    unsure_m: float = Field(default=0.0, ge=0.0)
    s_blind_min: NonNegativeInt = 0
    far_rad: float = Field(default=0.0, ge=0.0)
    s_far: NonNegativeInt = 0


DEFAULT = Profile(name="default")

THESIS = Profile(
    name="thesis",
    similarity="raw",
    s_edge_min=40,
    s_node_max=90,
    s_explored=60,
    s_via_min=30,
    s_via_max=85,
    s_final=105,
    s_slow=85,
    s_max=150,
    heading_method="histogram",
    exploration="strategies",
    path_cost="nodes",
    suspend_after=1,
    delete_edges=True,
    arrival_rad=0.0,
)

OUTDOOR = DEFAULT.model_copy(
    update={
        "name": "outdoor",
        "s_edge_min": 25,
        "s_node_max": 100,
        "s_explored": 28,
        "s_via_min": 16,
        "s_via_max": 120,
        "share_min": 0.5,
        "edge_candidates": 30,
        "explored_half_rad": math.radians(60.0),
        "near_half_rad": math.radians(75.0),
        "blind_half_rad": math.radians(30.0),
        "arrival_rad": math.radians(0.6),
        "travel_arrival_rad": math.radians(2.5),
        "near_rad": math.radians(2.0),
        "s_near": 240,
        "opening_m": 4.0,
        "blocked_m": 0.4,
        "doorway_m": 0.0,
        "departure_steps": 40,
        "robot_radius_m": 0.35,
        "robot_slim_m": 0.3,
        "disparity_rad_per_m": math.radians(2.2),
        "similarity_m": 300.0,
        "unsure_m": 750.0,
        "s_blind_min": 60,
        "far_rad": math.radians(3.5),
        "s_far": 110,
    }
)
"""Streets and yards, with 500 keypoints: places are 2 m apart, so that they recognise each other, and one
edge covers a wide sector.

From 120 pairs of village frames: 144 verified matches at 1 to 2 m, 78 at 2 to 3, 48 at 3 to 4, 40 at 4 to 6,
30 at 6 to 10; 3 degrees of disparity per metre within 2 m, half of that at 4; no bearing with more than 22 of
them was wrong.
"""

THESIS_OUTDOOR = THESIS.model_copy(
    update={
        name: getattr(OUTDOOR, name)
        for name in ("opening_m", "blocked_m", "doorway_m", "departure_steps", "disparity_rad_per_m")
    }
    | {"name": "thesis_outdoor", "heading_method": "4"}
)
"""The thesis's rules in its village: method 4 (section 4.3)."""

PROFILES = {profile.name: profile for profile in (DEFAULT, OUTDOOR, THESIS, THESIS_OUTDOOR)}


def profile_named(name: str) -> Profile:
    """Return the profile or raise ValueError listing the choices."""
    if name not in PROFILES:
        raise ValueError(f"planner profile must be one of {sorted(PROFILES)}, got {name!r}")
    return PROFILES[name]
