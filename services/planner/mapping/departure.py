"""Leaving a node, frame by frame: until what is seen is new, known, blocked, or aliased."""

import math
from dataclasses import dataclass

from services.planner.mapping.edges import judge_edges
from services.planner.mapping.frontiers.floor_gain import gain_here
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.near_nodes import NearNodes
from services.planner.mapping.nodes import add_node, is_new_node
from services.planner.ports import Decision, MapAccess, Matcher, Matches, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, trusted
from services.planner.surroundings import hidden_openings, through_gap
from shared.mapgraph.frontiers import mark_explored, sector_rad
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import (
    LONGEST_SHARE,
    ROOM_HALF_M,
    SHORTEST_M,
    keypoints_of,
    match_length_m,
    openness,
)
from shared.messages.maps import UpdateNode
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

CORNER_STEPS = 2
"""Steps after which a view that is out of sight of the map means a corner; chosen: before, a frame was
missed."""

UNSURE_FRAMES = 6
"""Frames that resemble nodes and tell no direction, as along a corrugated wall, before the robot goes back;
chosen: 0.7 m in a room."""

BESIDE_M = 0.2
"""Who is nearer to a node than this stands at it; chosen: two steps."""

ON_COURSE_RAD = math.radians(60.0)
"""A new node this far off the direction lies in another one; chosen: two sectors."""

DOORWAY_NODES = 3
"""Nearest nodes asked whether they know an opening; chosen: one before, one after and one beside it."""


@dataclass(frozen=True)
class NewNode:
    """A node was added where the robot stands."""

    node_id: int
    notes: tuple[Note, ...]


class Departure:
    """Leaving the node of `start` through `sector`, until `done` or a NewNode.

    Attributes:
        done: whether the direction is closed.
        heading_rad: where it leads, robot frame; held by the yaw towards the node left, and by turns since.
        unseen: whether the last frame showed nothing of the map.
        near: the nodes around, and where the robot is.
    """

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        sector: int,
        heading_rad: float,
        start: Displacement,
        views: FloorViews,
    ) -> None:
        self._profile, self._maps, self._views = profile, maps, views
        self.node_id, self.sector, self.heading_rad = start.node_id, sector, heading_rad
        self.near = NearNodes(profile, maps, matcher, start)
        self._steps = self._unseen_frames = self._unsure_frames = 0.0
        self._share = 1.0
        self._driven_m = 0.0
        self._carries = openness(maps.graph, start.node_id)
        self._retreating = False
        self._began_beside = self._beside = start.length_m > BESIDE_M
        self._back_to_node = False
        self.done = self.unseen = False
        self.progress = Progress()

    @property
    def here(self) -> Displacement:
        """Where the robot is, by what it did since."""
        return self.near.here

    def step(self, observation: Observation) -> Decision | NewNode:
        """Go straight on, or end."""
        self._share = observation.frame_share
        self._steps += self._share
        self._driven_m += observation.moved.way_m
        rules = self._profile.mapping
        self.near.moved(observation.moved)
        self.heading_rad = observation.moved.direction(self.heading_rad)
        matches = self.near.seen()
        best = ranked(matches, self._profile)
        s_best = similarity(best[0][1], self._profile) if best else 0
        self.progress = Progress(nearest_node=best[0][0] if best else None, similarity=s_best)
        self.unseen = s_best <= rules.s_edge_min
        self._keep_course(matches.get(self.node_id))
        self._views.add(self.here, observation.ranges)
        if self.unseen:
            return self._out_of_sight(s_best)
        if self._retreating or self._doorway(observation.ranges, matches):
            return self._new_node(observation, {**self.near.candidates(), **matches})
        if is_new_node(matches, self._profile) and not self.near.is_crowded(matches):
            return self._new_or_known(observation, {**self.near.candidates(), **matches})
        if self._driven_m > rules.departure_m * self._room_lengths(matches.get(self.node_id)):
            gain = gain_here(self._maps.graph, self.here, observation.ranges, self._profile, self._views)
            if gain >= rules.gain_min:
                return self._new_node(observation, {**self.near.candidates(), **matches})
            return self._close("nothing new on the way")
        return self._straight_on(observation.ranges, s_best)

    def _room_lengths(self, origin: NodeMatch | None) -> float:
        """How many times as far as in a room a departure goes: as views carry, unless nodes cover less."""
        return min(self._view_carries(origin), self._profile.mapping.covers_m or math.inf)

    def _view_carries(self, origin: NodeMatch | None) -> float:
        """How many times further views carry here than in a room, as far as this way has told."""
        graph = self._maps.graph
        if origin is not None and origin.status == "ok" and self.here.length_m > SHORTEST_M:
            told = self.here.length_m / match_length_m(
                origin.inliers, keypoints_of(graph, self.node_id), ROOM_HALF_M
            )
            self._carries = min(max(self._carries, told), LONGEST_SHARE)
        return self._carries

    def _straight_on(self, ranges: Ranges, s_best: int) -> Decision:
        """On in the direction; where it is blocked beside the node, first to the node: it was open there."""
        if self._back_to_node and self.here.length_m > BESIDE_M:
            heading_rad, free_m = through_gap(ranges, self.here.back_rad, self._profile)
            if free_m >= self._profile.sensing.blocked_m:
                return _go(heading_rad, f"to node {self.node_id}, to leave from there")
        self._back_to_node = False
        heading_rad, free_m = through_gap(ranges, self.heading_rad, self._profile)
        if free_m >= self._profile.sensing.blocked_m:
            return _go(heading_rad, f"leaving node {self.node_id}, S {s_best}")
        if not self._beside:
            return self._close("blocked by an obstacle")
        self._beside, self._back_to_node = False, True
        return self._straight_on(ranges, s_best)

    def _keep_course(self, origin: NodeMatch | None) -> None:
        """Straight on by the yaw of the node left; and where that and a sure bearing put the robot."""
        yaw_rad = self.near.locate(origin)
        if yaw_rad is not None:
            self.heading_rad = math.remainder(sector_rad(self.sector) + yaw_rad, math.tau)

    def _new_or_known(self, observation: Observation, matches: Matches) -> Decision | NewNode:
        """New unless a node is too similar that lies here: another room furnished alike makes none known."""
        graph = self._maps.graph
        edges = judge_edges(graph, observation, matches, self._profile, self.here)
        credible = self.near.credible(matches, edges)
        if is_new_node(credible, self._profile):
            return self._new_node(observation, credible)
        return self._close(f"leads to node {ranked(credible, self._profile)[0][0]}")

    def _out_of_sight(self, s_best: int) -> Decision:
        """The view changed within a few steps, as at a corner: go back and make a node there."""
        self._unseen_frames += self._share
        if self._unseen_frames > self._profile.mapping.saturation_steps:
            return self._close("out of sight of the map", lost=True)
        self._retreating = self._steps > CORNER_STEPS
        heading = self.heading_rad + (math.pi if self._retreating else 0.0)
        return _go(heading, f"out of sight of the map, S {s_best}")

    def _doorway(self, ranges: Ranges, matches: Matches) -> bool:
        """Whether a way out shows beside the way that the nodes around do not know."""
        if not self._profile.sensing.doorway_m or is_new_node(matches, self._profile):
            return False
        nodes = self._maps.graph.nodes
        seen = [(n, m) for n, m in ranked(matches, self._profile) if n in nodes and trusted(m, self._profile)]
        near = [(nodes[n], m.yaw_rad or 0.0) for n, m in seen[:DOORWAY_NODES]]
        return bool(near) and bool(hidden_openings(ranges, near, self._profile))

    def _new_node(self, observation: Observation, matches: Matches) -> Decision | NewNode:
        graph = self._maps.graph
        edges = judge_edges(graph, observation, matches, self._profile, self.here)
        if not edges.admitted:
            self._unsure_frames += self._share
            if self._retreating or self._unsure_frames > UNSURE_FRAMES:
                return self._close("no view back to be sure of", lost=True)
            return self._straight_on(
                observation.ranges, similarity(ranked(matches, self._profile)[0][1], self._profile)
            )
        if self._is_on_course():
            self._mark_explored()
        node_id, refused = add_node(self._maps, observation, edges, self._profile, self.here, self._views)
        count = len(self._maps.graph.neighbours(node_id))
        nearest, match = ranked(matches, self._profile)[0]
        values: dict[str, float | int | str | bool | None] = {
            "node": node_id,
            "edges": count,
            "nearest": nearest,
            "s": similarity(match, self._profile),
        }
        return NewNode(node_id, (Note("node_added", f"new node with {count} edges", values), *refused))

    def _is_on_course(self) -> bool:
        """Whether the robot went in the direction: one that began beside its node may still be there."""
        bearing_rad = math.atan2(self.here.y_m, self.here.x_m)
        off_rad = abs(math.remainder(bearing_rad - sector_rad(self.sector), math.tau))
        return not self._began_beside or off_rad < ON_COURSE_RAD

    def _close(self, why: str, *, lost: bool = False) -> Decision:
        """This direction is done; go back to known ground when nothing is seen."""
        self._mark_explored()
        self.done = True
        note = Note("direction_closed", f"node {self.node_id} direction {self.sector}: {why}")
        if lost:
            back_rad = math.remainder(self.heading_rad + math.pi, math.tau)
            return Decision("go", back_rad, 0, 1.0, "reverse", f"lost mode: {why}", (note,))
        return Decision("hold", why=why, notes=(note,))

    def _mark_explored(self) -> None:
        node = self._maps.graph.nodes.get(self.node_id)
        if node is not None and not node.explored[self.sector]:
            self._maps.commit([UpdateNode(node=mark_explored(node, self.sector))])


def _go(heading_rad: float, why: str) -> Decision:
    return Decision("go", math.remainder(heading_rad, math.tau), 0, 1.0, "frontier", why)
