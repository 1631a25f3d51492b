"""Mission explore by frontiers: leave a place in an unexplored open direction, add what is new, repeat.

The node and edge rules are the thesis's (equations 4.1, 4.2); the choice of direction replaces its random
strategies, so that the map stops growing only when nothing open is left.
"""

import math

import numpy as np

from services.planner.departure import Departure
from services.planner.experience import Experience, Leg
from services.planner.following import PathFollower, Target
from services.planner.frontiers import (
    best_sector,
    frontier_sectors,
    mark_explored,
    open_directions,
    sector_rad,
)
from services.planner.graph import MapGraph
from services.planner.mapping import Edges, add_place, is_new_place, judge_edges
from services.planner.ports import Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.routing import plan_path, visible
from services.planner.search import Search, search_back
from services.planner.similarity import ranked, similarity, trusted
from services.planner.surroundings import free_way_m, hidden_openings, is_clear, through_gap_rad
from shared.messages.maps import Node, UpdateNode
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

NEAR_NODES = 5
KNOWN_STEPS = 1
CORNER_STEPS = 2
DOORWAY_NODES = 3
MAX_TRAVEL_FAILURES = 2
SEARCH_STEPS = 120
TRAVELS_IN_VAIN = 4


class FrontierExploration:
    """Decides per frame; everything it must not forget is in the map (open and explored directions)."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, rng: np.random.Generator) -> None:
        self._profile, self._maps, self._matcher, self._rng = profile, maps, matcher, rng
        self._departure: Departure | None = None
        self._travel: PathFollower | None = None
        self._last_heading_rad = 0.0
        self._failures: dict[int, int] = {}
        self._doubted: set[Leg] = set()
        self._experience = Experience(profile, maps)
        self._search: Search | None = None
        self._cut_off = 0
        self._bad_starts: set[int] = set()
        self._in_vain = 0
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One step."""
        if not self._maps.graph.nodes:
            return self._first(observation)
        if self._departure is not None:
            return self._depart(observation, self._departure)
        if self._travel is not None:
            return self._go_on(observation, self._travel)
        return self._choose(observation)

    def _first(self, observation: Observation) -> Decision:
        """The only node: random heading (thesis section 4.2)."""
        node_id, _ = add_place(self._maps, observation, Edges(), self._profile, None)
        self._last_heading_rad = float(self._rng.uniform(-math.pi, math.pi))
        return self._leave(node_id, 0.0, (Note("node_added", "first place of the map", {"node": node_id}),))

    def _leave(self, node_id: int, yaw_rad: float, notes: tuple[Note, ...]) -> Decision:
        """Start a departure from a node the robot stands at, or hold when it has no frontier."""
        node = self._maps.graph.nodes[node_id]
        sector = best_sector(node, self._last_heading_rad - yaw_rad)
        if sector is None:
            return Decision("hold", why=f"node {node_id} has no unexplored direction", notes=notes)
        heading_rad = math.remainder(sector_rad(sector) + yaw_rad, math.tau)
        self._departure = Departure(node_id, sector, heading_rad)
        self._last_heading_rad = heading_rad
        why = f"leaving node {node_id} by direction {sector}"
        return Decision("go", heading_rad, method="frontier", why=why, notes=notes)

    def _depart(self, observation: Observation, departure: Departure) -> Decision:
        """Go straight until the place is new, known, blocked or out of sight."""
        departure.steps += 1
        matches = self._matcher.match(self._near(departure.node_id), 0)
        origin = matches.get(departure.node_id)
        best = ranked(matches, self._profile)
        s_best = similarity(best[0][1], self._profile) if best else 0
        self.progress = Progress(nearest_node=best[0][0] if best else None, similarity=s_best)
        if origin is not None and trusted(origin, self._profile) and origin.yaw_rad is not None:
            departure.heading_rad = math.remainder(sector_rad(departure.sector) + origin.yaw_rad, math.tau)
        if s_best <= self._profile.s_edge_min:
            return self._out_of_sight(departure, s_best)
        if self._profile.similarity == "verified" and not departure.follows(origin, self._profile):
            return self._lost_track(departure)
        if departure.retreating:
            everything = {**self._candidates(), **matches}
            return self._new_place(observation, departure, everything)
        if is_new_place(matches, self._profile):
            merged = {**self._candidates(), **matches}
            credible = self._credible(observation, merged, departure.node_id)
            if is_new_place(credible, self._profile):
                return self._new_place(observation, departure, credible)
            return self._known(departure, credible)
        if self._doorway(observation.ranges, matches):
            everything = {**self._candidates(), **matches}
            return self._new_place(observation, departure, everything)
        if free_way_m(observation.ranges, departure.heading_rad, self._profile) < self._profile.blocked_m:
            return self._close_departure(departure, "blocked by an obstacle")
        if departure.steps > self._profile.departure_steps:
            return self._close_departure(departure, "nothing new on the way")
        heading_rad = through_gap_rad(observation.ranges, departure.heading_rad, self._profile)
        why = f"leaving node {departure.node_id}, S {s_best}"
        return Decision("go", heading_rad, 0, 1.0, "frontier", why)

    def _lost_track(self, departure: Departure) -> Decision:
        """The place left seems to lie elsewhere all at once: go back to where it did not."""
        departure.unseen_steps += 1
        if departure.unseen_steps > self._profile.saturation_steps:
            return self._close_departure(departure, "the view back looks like another", lost=True)
        departure.retreating = True
        back = departure.heading_rad + math.pi
        why = f"the direction back to node {departure.node_id} jumped"
        return Decision("go", math.remainder(back, math.tau), 0, 1.0, "frontier", why)

    def _credible(
        self, observation: Observation, matches: dict[int, NodeMatch], origin: int
    ) -> dict[int, NodeMatch]:
        """Matches without those that the map speaks against: look-alikes make no place known."""
        refused = judge_edges(self._maps.graph, observation, matches, self._profile, origin).refused
        return {n: m for n, m in matches.items() if n not in refused or n == origin}

    def _doorway(self, ranges: Ranges, matches: dict[int, NodeMatch]) -> bool:
        """Whether a way out shows beside the way that the places around do not know."""
        nodes = self._maps.graph.nodes
        seen = [(n, m) for n, m in ranked(matches, self._profile) if n in nodes and trusted(m, self._profile)]
        near = [(nodes[n], m.yaw_rad or 0.0) for n, m in seen[:DOORWAY_NODES]]
        return bool(near) and bool(hidden_openings(ranges, near, self._profile))

    def _out_of_sight(self, departure: Departure, s_best: int) -> Decision:
        """The view changed within a few steps, as at a corner: go back and make a place there."""
        departure.unseen_steps += 1
        if departure.unseen_steps > self._profile.saturation_steps:
            return self._close_departure(departure, "out of sight of the map", lost=True)
        departure.retreating = departure.steps > CORNER_STEPS
        heading = departure.heading_rad + (math.pi if departure.retreating else 0.0)
        why = f"out of sight of the map, S {s_best}"
        return Decision("go", math.remainder(heading, math.tau), 0, 1.0, "frontier", why)

    def _known(self, departure: Departure, matches: dict[int, NodeMatch]) -> Decision:
        """Another node is too similar: after a few such frames this direction is known."""
        departure.known_steps += 1
        best = ranked(matches, self._profile)[0]
        if departure.known_steps >= KNOWN_STEPS:
            return self._close_departure(departure, f"leads to node {best[0]}")
        why = f"near node {best[0]}, S {similarity(best[1], self._profile)}"
        return Decision("go", departure.heading_rad, 0, 1.0, "frontier", why)

    def _new_place(
        self, observation: Observation, departure: Departure, matches: dict[int, NodeMatch]
    ) -> Decision:
        edges_of = judge_edges(self._maps.graph, observation, matches, self._profile, departure.node_id)
        if not edges_of.admitted:
            return self._close_departure(departure, "no view back to be sure of", lost=True)
        self._explored(departure)
        node_id, refused = add_place(self._maps, observation, edges_of, self._profile, departure.node_id)
        self._departure, self._search = None, None
        self._last_heading_rad = departure.heading_rad
        edges = len(self._maps.graph.neighbours(node_id))
        best = ranked(matches, self._profile)[0]
        values = {
            "node": node_id,
            "edges": edges,
            "nearest": best[0],
            "s": similarity(best[1], self._profile),
        }
        added = Note("node_added", f"new place with {edges} edges", dict(values))
        return self._leave(node_id, 0.0, (added, *refused))

    def _close_departure(self, departure: Departure, why: str, *, lost: bool = False) -> Decision:
        """This direction is done; go back to known ground when nothing is seen."""
        self._explored(departure)
        self._departure = None
        note = Note("direction_closed", f"node {departure.node_id} direction {departure.sector}: {why}")
        if lost:
            back = math.remainder(departure.heading_rad + math.pi, math.tau)
            return Decision("go", back, 0, 1.0, "reverse", f"lost mode: {why}", (note,))
        return Decision("hold", why=why, notes=(note,))

    def _explored(self, departure: Departure) -> None:
        node = self._maps.graph.nodes.get(departure.node_id)
        if node is not None and not node.explored[departure.sector]:
            self._maps.commit([UpdateNode(node=mark_explored(node, departure.sector))])

    def _choose(self, observation: Observation) -> Decision:
        """Nearest node with something unexplored; none left: the map is complete."""
        graph = self._maps.graph
        frontier = {n: 0.0 for n, node in graph.nodes.items() if frontier_sectors(node)}
        if not frontier:
            why = f"nothing unexplored is left: {len(graph.nodes)} places, {len(graph.edges)} edges"
            return Decision("hold", why=why, outcome="succeeded")
        matches = self._matcher.match([], NEAR_NODES)
        clear = {n for n, m in matches.items() if is_clear(m, observation.ranges, self._profile)}
        starts = visible(matches, self._profile, self._profile.s_via_min, clear)
        fresh = {n: cost for n, cost in starts.items() if n not in self._bad_starts} or starts
        path = plan_path(graph, fresh, frontier, self._profile, self._doubted, self._experience.banned)
        if not path:
            return self._no_way(frontier) if starts else self._look_for_map(matches)
        self._search, self._cut_off = None, 0
        target = Target(None, self._profile.travel_arrival_rad)
        self._travel = PathFollower(self._profile, self._maps, path, target, self._doubted, self._experience)
        return self._go_on(observation, self._travel)

    def _go_on(self, observation: Observation, travel: PathFollower) -> Decision:
        state, decision = travel.step(observation, self._matcher)
        self.progress = travel.progress
        end = travel.path[-1]
        if state == "going":
            return decision
        failed_leg = travel.current_leg()
        self._travel = None
        if state == "arrived":
            self._bad_starts, self._in_vain = set(), 0
            match = self._matcher.match([end]).get(end)
            yaw = match.yaw_rad if match is not None and match.yaw_rad is not None else 0.0
            return self._leave(end, yaw, decision.notes)
        if state == "unclear":
            self._doubted.add(travel.next_leg())
            return Decision("hold", why=f"planning again: {decision.why}", notes=decision.notes)
        if failed_leg is None:
            self._bad_starts.add(travel.path[travel.index])
        self._in_vain += 1
        blamed = travel.path[travel.index] == end or self._in_vain > TRAVELS_IN_VAIN
        return self._travel_failed(end, failed_leg, decision, blamed=blamed)

    def _travel_failed(
        self, end: int, failed_leg: Leg | None, decision: Decision, *, blamed: bool
    ) -> Decision:
        """Twice in vain: that node's directions are closed, so that exploration always ends.

        A way that ended early blames its end only when others ended before it.
        """
        self._failures[end] = self._failures.get(end, 0) + blamed
        notes = (*decision.notes, Note("travel_failed", f"to node {end}: {decision.why}"))
        if failed_leg is not None:
            notes += (self._experience.failed(failed_leg, decision.why),)
        if self._failures[end] >= MAX_TRAVEL_FAILURES:
            node = self._maps.graph.nodes[end]
            self._maps.commit([UpdateNode(node=_closed(node))])
            notes += (Note("node_unreachable", f"node {end}: its directions are closed"),)
        return Decision("hold", why=decision.why, notes=notes)

    def _no_way(self, frontier: dict[int, float]) -> Decision:
        """Known places are seen, but no path leads on: after a few such frames what is left is closed."""
        self._cut_off += 1
        why = f"no path to {len(frontier)} places with unexplored directions"
        if self._cut_off < self._profile.saturation_steps:
            return Decision("hold", why=why)
        nodes = self._maps.graph.nodes
        self._maps.commit([UpdateNode(node=_closed(nodes[n])) for n in frontier])
        values: dict[str, float | int | str | bool | None] = {"nodes": len(frontier)}
        return Decision("hold", why=why, notes=(Note("nodes_unreachable", f"{why}: closed", values),))

    def _look_for_map(self, matches: dict[int, NodeMatch]) -> Decision:
        """Lost mode (thesis section 4.2): towards the most similar place, else in growing sweeps."""
        if self._search is None:
            self._search = search_back(self._last_heading_rad, SEARCH_STEPS)
        if self._search.exhausted:
            why = f"no known place found again in {SEARCH_STEPS} steps"
            return Decision("hold", why=why, outcome="failed", failure="lost")
        heading_rad = self._search.next_heading()
        best = ranked(matches, self._profile)[:1]
        if best and best[0][1].heading_rad is not None:
            why = f"lost mode: towards node {best[0][0]}"
            return Decision("go", best[0][1].heading_rad, 0, 1.0, "search", why)
        return Decision("go", heading_rad, 0, 1.0, "search", "lost mode: back, then in growing sweeps")

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

    def open_directions(self) -> int:
        """Frontiers left in the map."""
        return open_directions(self._maps.graph)


def _inliers(graph: MapGraph, first: int, second: int) -> int:
    edge = graph.edge(first, second)
    return edge.inliers if edge is not None else 0


def _closed(node: Node) -> Node:
    return node.model_copy(update={"explored": (True,) * len(node.explored)})
