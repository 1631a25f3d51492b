"""Exploration by the thesis's own strategies, section 4.2: exploration, admissible heading, lost mode."""

import math

import numpy as np

from services.planner.mapping.edges import NewEdges, judge_edges
from services.planner.mapping.nodes import add_node, is_new_node
from services.planner.ports import Decision, MapAccess, Matcher, Matches, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, ranked, similarity
from shared.messages.matching import NodeMatch

COMPARED_NODES = 30
"""Nodes verified per frame; all are compared by descriptors."""

SETTLED_STEPS = 300
"""Steps without a new node after which the map counts as complete; the thesis stopped by hand."""


class ThesisExploration:
    """Every frame is judged as a node of the map, written only if it stays; random headings grow the map."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, rng: np.random.Generator) -> None:
        self._profile, self._maps, self._matcher, self._rng = profile, maps, matcher, rng
        self._previous_rad = 0.0
        self._saturation = 0
        self._lost = False
        self._settled = 0
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One step of figure 4.5's mapping branch."""
        self._previous_rad = observation.moved.direction(self._previous_rad)
        if not self._maps.graph.nodes:
            node, _ = add_node(self._maps, observation, NewEdges(), self._profile, None)
            return self._go(self._uniform(math.pi), "only node: random heading", (_added(node, 0),))
        matches = self._matcher.match([], COMPARED_NODES)
        best = ranked(matches, self._profile)
        s_nearest = similarity(best[0][1], self._profile) if best else 0
        self.progress = Progress(nearest_node=best[0][0] if best else None, similarity=s_nearest)
        if self._lost:
            return self._return_to_last()
        notes = self._add_if_new(observation, matches)
        self._settled = 0 if notes else self._settled + 1
        if self._settled > SETTLED_STEPS:
            return Decision("hold", why=f"no new node for {SETTLED_STEPS} steps", outcome="succeeded")
        return self._head(best, notes)

    def _add_if_new(self, observation: Observation, matches: Matches) -> tuple[Note, ...]:
        if not is_new_node(matches, self._profile):
            return ()
        edges = judge_edges(self._maps.graph, observation, matches, self._profile, None)
        node, _ = add_node(self._maps, observation, edges, self._profile, None)
        return (_added(node, len(self._maps.graph.neighbours(node))),)

    def _head(self, best: list[tuple[int, NodeMatch]], notes: tuple[Note, ...]) -> Decision:
        """Exploration when both nearest nodes are in the band, else the admissible heading."""
        in_band = [match for _, match in best[:2] if self._in_band(match)]
        s_nearest = similarity(best[0][1], self._profile) if best else 0
        headings = [found[0] for match in in_band if (found := heading_of(match, self._profile)) is not None]
        if len(headings) == 2:
            bisector = _bisector(*headings)
            noise = self._uniform(self._profile.mapping.exploration_noise_rad)
            return self._go(bisector + math.pi + noise, "exploration: away from the two nearest", notes)
        if s_nearest > self._profile.mapping.s_edge_min:
            self._saturation = 0
            found = heading_of(best[0][1], self._profile)
            away = found[0] + math.pi if found is not None else self._previous_rad
            noise = self._uniform(self._profile.mapping.admissible_noise_rad)
            return self._go(away + noise, "admissible: away from the nearest", notes)
        return self._unseen(notes)

    def _unseen(self, notes: tuple[Note, ...]) -> Decision:
        self._saturation += 1
        if self._saturation >= self._profile.mapping.saturation_steps:
            self._lost = True
            note = Note("lost_mode", f"nothing similar for {self._saturation} steps")
            return self._go(self._previous_rad + math.pi, "lost mode: reverse", (*notes, note))
        noise = self._uniform(self._profile.mapping.admissible_noise_rad)
        return self._go(self._previous_rad + noise, "admissible: previous heading", notes)

    def _return_to_last(self) -> Decision:
        """Head for the last added node until it is approached (section 4.2)."""
        last = max(self._maps.graph.nodes)
        match = self._matcher.match([last]).get(last)
        if match is not None and similarity(match, self._profile) > self._profile.mapping.s_node_max:
            self._lost, self._saturation = False, 0
            return self._go(self._previous_rad, "lost mode ends", (Note("found_again", f"at node {last}"),))
        found = heading_of(match, self._profile) if match is not None else None
        if found is None:
            return self._go(self._previous_rad, "lost mode: keep reversing", ())
        return self._go(found[0], f"lost mode: towards node {last}", ())

    def _in_band(self, match: NodeMatch) -> bool:
        return (
            self._profile.mapping.s_node_max
            > similarity(match, self._profile)
            > self._profile.mapping.s_edge_min
        )

    def _uniform(self, half_rad: float) -> float:
        return float(self._rng.uniform(-half_rad, half_rad))

    def _go(self, heading_rad: float, why: str, notes: tuple[Note, ...]) -> Decision:
        self._previous_rad = math.remainder(heading_rad, math.tau)
        return Decision("go", self._previous_rad, 0, 1.0, self._profile.sensing.heading_method, why, notes)


def _added(node: int, edges: int) -> Note:
    return Note("node_added", f"new node with {edges} edges", {"node": node, "edges": edges})


def _bisector(first_rad: float, second_rad: float) -> float:
    x, y = math.cos(first_rad) + math.cos(second_rad), math.sin(first_rad) + math.sin(second_rad)
    return math.atan2(y, x)
