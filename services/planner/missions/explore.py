"""Mission explore by frontiers: leave a place in an unexplored open direction, add what is new, repeat.

The node and edge rules are the thesis's (equations 4.1, 4.2); the choice of direction replaces its random
strategies, so that the map stops growing only when nothing open is left.
"""

import math

import numpy as np

from services.planner.frontiers import best_sector, open_directions, sector_rad
from services.planner.mapping.departure import Departure
from services.planner.mapping.leaving import Leaving, NewPlace
from services.planner.mapping.places import Edges, add_place
from services.planner.mapping.second_look import look_again
from services.planner.ports import Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.travel.frontier_travel import Arrival, FrontierTravel


class FrontierExploration:
    """Decides per frame; everything it must not forget is in the map (open and explored directions)."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, rng: np.random.Generator) -> None:
        self._profile, self._maps, self._matcher, self._rng = profile, maps, matcher, rng
        self._leaving: Leaving | None = None
        self._travel = FrontierTravel(profile, maps, matcher)
        self._last_heading_rad = 0.0
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One step."""
        if not self._maps.graph.nodes:
            return self._first(observation)
        if self._leaving is not None:
            return self._go_on_leaving(observation, self._leaving)
        result = self._travel.step(observation, self._last_heading_rad)
        self.progress = self._travel.progress or self.progress
        if isinstance(result, Arrival):
            seen = self._look_again(observation, result)
            return self._leave(result.node_id, result.yaw_rad, (*result.notes, *seen))
        return result

    def open_directions(self) -> int:
        """Frontiers left in the map."""
        return open_directions(self._maps.graph)

    def _look_again(self, observation: Observation, arrival: Arrival) -> tuple[Note, ...]:
        matches = self._matcher.match([], self._profile.edge_candidates)
        return look_again(self._maps, observation, matches, self._profile, arrival.node_id, arrival.yaw_rad)

    def _first(self, observation: Observation) -> Decision:
        """The only node: random heading (thesis section 4.2)."""
        node_id, _ = add_place(self._maps, observation, Edges(), self._profile, None)
        self._last_heading_rad = float(self._rng.uniform(-math.pi, math.pi))
        return self._leave(node_id, 0.0, (Note("node_added", "first place of the map", {"node": node_id}),))

    def _leave(self, node_id: int, yaw_rad: float, notes: tuple[Note, ...]) -> Decision:
        """Start a departure from a node the robot stands at, or hold when it has no frontier."""
        self._travel.stand_at(node_id)
        node = self._maps.graph.nodes[node_id]
        sector = best_sector(node, self._last_heading_rad - yaw_rad)
        if sector is None:
            return Decision("hold", why=f"node {node_id} has no unexplored direction", notes=notes)
        heading_rad = math.remainder(sector_rad(sector) + yaw_rad, math.tau)
        departure = Departure(node_id, sector, heading_rad)
        self._leaving = Leaving(self._profile, self._maps, self._matcher, departure)
        self._last_heading_rad = heading_rad
        why = f"leaving node {node_id} by direction {sector}"
        return Decision("go", heading_rad, method="frontier", why=why, notes=notes)

    def _go_on_leaving(self, observation: Observation, leaving: Leaving) -> Decision:
        result = leaving.step(observation)
        self.progress = leaving.progress
        if isinstance(result, NewPlace):
            self._leaving = None
            self._last_heading_rad = leaving.heading_rad
            return self._leave(result.node_id, 0.0, result.notes)
        if leaving.done:
            self._leaving = None
        return result
