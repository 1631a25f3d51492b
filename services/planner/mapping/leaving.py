"""Leaving a place, frame by frame: until what is seen is new, known, blocked, or like another place."""

import math
from dataclasses import dataclass

from services.planner.closures import far_places
from services.planner.frontiers import mark_explored, sector_rad
from services.planner.graph import MapGraph
from services.planner.mapping.departure import Departure
from services.planner.mapping.places import add_place, is_new_place, judge_edges
from services.planner.mapping.surroundings import free_way_m, hidden_openings, through_gap_rad
from services.planner.ports import Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, trusted
from shared.messages.maps import UpdateNode
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

NEAR_NODES = 5
CORNER_STEPS = 2
DOORWAY_NODES = 3


@dataclass(frozen=True)
class NewPlace:
    """A place was added where the robot stands."""

    node_id: int
    notes: tuple[Note, ...]


class Leaving:
    """One departure. `done` once the direction is closed; a NewPlace ends it as well."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, departure: Departure) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._departure = departure
        self.done = False
        self.progress = Progress()

    @property
    def heading_rad(self) -> float:
        """Where the departure leads, robot frame."""
        return self._departure.heading_rad

    def step(self, observation: Observation) -> Decision | NewPlace:
        """Go straight on, or end."""
        departure = self._departure
        departure.steps += 1
        matches = self._matcher.match(self._near(departure.node_id), 0)
        origin = matches.get(departure.node_id)
        best = ranked(matches, self._profile)
        s_best = similarity(best[0][1], self._profile) if best else 0
        self.progress = Progress(nearest_node=best[0][0] if best else None, similarity=s_best)
        if origin is not None and trusted(origin, self._profile) and origin.yaw_rad is not None:
            departure.heading_rad = math.remainder(sector_rad(departure.sector) + origin.yaw_rad, math.tau)
        if s_best <= self._profile.s_edge_min:
            return self._out_of_sight(s_best)
        if self._profile.similarity == "verified" and not departure.follows(origin, self._profile):
            return self._lost_track()
        if departure.retreating or self._doorway(observation.ranges, matches):
            return self._new_place(observation, {**self._candidates(), **matches})
        if is_new_place(matches, self._profile):
            return self._new_or_known(observation, {**self._candidates(), **matches})
        if free_way_m(observation.ranges, departure.heading_rad, self._profile) < self._profile.blocked_m:
            return self._close("blocked by an obstacle")
        if departure.steps > self._profile.departure_steps:
            return self._close("nothing new on the way")
        heading_rad = through_gap_rad(observation.ranges, departure.heading_rad, self._profile)
        return _go(heading_rad, f"leaving node {departure.node_id}, S {s_best}")

    def _new_or_known(self, observation: Observation, matches: dict[int, NodeMatch]) -> Decision | NewPlace:
        """New unless some place of the whole map is too similar; look-alikes make no place known."""
        origin = self._departure.node_id
        graph = self._maps.graph
        edges_of = judge_edges(graph, observation, matches, self._profile, origin)
        credible = {n: m for n, m in matches.items() if n not in edges_of.refused or n == origin}
        closes_loop = self._profile.s_far and far_places(graph, edges_of.admitted, origin)
        if is_new_place(credible, self._profile) or closes_loop:
            return self._new_place(observation, credible)
        return self._close(f"leads to node {ranked(credible, self._profile)[0][0]}")

    def _out_of_sight(self, s_best: int) -> Decision:
        """The view changed within a few steps, as at a corner: go back and make a place there."""
        departure = self._departure
        departure.unseen_steps += 1
        if departure.unseen_steps > self._profile.saturation_steps:
            return self._close("out of sight of the map", lost=True)
        departure.retreating = departure.steps > CORNER_STEPS
        heading = departure.heading_rad + (math.pi if departure.retreating else 0.0)
        return _go(heading, f"out of sight of the map, S {s_best}")

    def _lost_track(self) -> Decision:
        """The place left seems to lie elsewhere all at once: go back to where it did not."""
        departure = self._departure
        departure.unseen_steps += 1
        if departure.unseen_steps > self._profile.saturation_steps:
            return self._close("the view back looks like another", lost=True)
        departure.retreating = True
        back_rad = departure.heading_rad + math.pi
        return _go(back_rad, f"the direction back to node {departure.node_id} jumped")

    def _doorway(self, ranges: Ranges, matches: dict[int, NodeMatch]) -> bool:
        """Whether a way out shows beside the way that the places around do not know."""
        if not self._profile.doorway_m or is_new_place(matches, self._profile):
            return False
        nodes = self._maps.graph.nodes
        seen = [(n, m) for n, m in ranked(matches, self._profile) if n in nodes and trusted(m, self._profile)]
        near = [(nodes[n], m.yaw_rad or 0.0) for n, m in seen[:DOORWAY_NODES]]
        return bool(near) and bool(hidden_openings(ranges, near, self._profile))

    def _new_place(self, observation: Observation, matches: dict[int, NodeMatch]) -> Decision | NewPlace:
        origin = self._departure.node_id
        edges_of = judge_edges(self._maps.graph, observation, matches, self._profile, origin)
        if not edges_of.admitted:
            return self._close("no view back to be sure of", lost=True)
        self._explored()
        node_id, refused = add_place(self._maps, observation, edges_of, self._profile, origin)
        edges = len(self._maps.graph.neighbours(node_id))
        nearest, match = ranked(matches, self._profile)[0]
        s_nearest = similarity(match, self._profile)
        values: dict[str, float | int | str | bool | None] = {
            "node": node_id, "edges": edges, "nearest": nearest, "s": s_nearest,
        }  # fmt: skip
        added = Note("node_added", f"new place with {edges} edges", values)
        return NewPlace(node_id, (added, *refused))

    def _close(self, why: str, *, lost: bool = False) -> Decision:
        """This direction is done; go back to known ground when nothing is seen."""
        departure = self._departure
        self._explored()
        self.done = True
        note = Note("direction_closed", f"node {departure.node_id} direction {departure.sector}: {why}")
        if lost:
            back_rad = math.remainder(departure.heading_rad + math.pi, math.tau)
            return Decision("go", back_rad, 0, 1.0, "reverse", f"lost mode: {why}", (note,))
        return Decision("hold", why=why, notes=(note,))

    def _explored(self) -> None:
        node = self._maps.graph.nodes.get(self._departure.node_id)
        if node is not None and not node.explored[self._departure.sector]:
            self._maps.commit([UpdateNode(node=mark_explored(node, self._departure.sector))])

    def _candidates(self) -> dict[int, NodeMatch]:
        """Places that may get an edge: the most similar ones, or the newest (thesis section 6.1.1)."""
        newest = self._profile.edge_window
        if not newest:
            return self._matcher.match([], self._profile.edge_candidates)
        return self._matcher.match(sorted(self._maps.graph.nodes)[-newest:], 0)

    def _near(self, node_id: int) -> list[int]:
        """The node left and the neighbours most similar to it."""
        graph = self._maps.graph
        around = sorted(graph.neighbours(node_id), key=lambda n: -_inliers(graph, node_id, n))
        return [node_id, *around[: NEAR_NODES - 1]]


def _go(heading_rad: float, why: str) -> Decision:
    return Decision("go", math.remainder(heading_rad, math.tau), 0, 1.0, "frontier", why)


def _inliers(graph: MapGraph, first: int, second: int) -> int:
    edge = graph.edge(first, second)
    return edge.inliers if edge is not None else 0
