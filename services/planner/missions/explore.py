"""Mission explore by frontiers: leave a node in an unexplored open direction, add what is new, repeat.

The node and edge rules are the thesis's (equations 4.1, 4.2); the choice of direction replaces its random
strategies, so that the map stops growing only when nothing open is left. A profile may choose the strategies.
"""

import math

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from services.planner.mapping.departure import Departure, NewNode
from services.planner.mapping.edges import NewEdges
from services.planner.mapping.frontiers.allowed_directions import AllowedDirections
from services.planner.mapping.frontiers.floor_gain import best_sector
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.nodes import add_node
from services.planner.mapping.reach import nodes_nearby
from services.planner.mapping.reobservation import close_known_directions
from services.planner.mapping.strategies import ThesisExploration
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.ports import Decision, MapAccess, Matcher, Mission, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.frontier_destination import FrontierDestination
from services.planner.travel.machine import Travel
from services.planner.travel.states import State
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.frontiers import open_directions, sector_rad
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import half_m, openness

TELLING_NODES = 6
"""Nodes after which driving tells what kind of place this is; chosen: some 50 steps."""
NEWS = 1.3
"""By so much must that change to be told again; chosen: more than from room to room."""


class ExploreParameters(BaseModel):
    """How dense the map is to be."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    covers_m: float | None = Field(
        default=None,
        gt=0.0,
        le=20.0,
        description="Metres around a node that need no other one; by the place.",
    )


class FrontierExploration:
    """Decides per frame; everything it must not forget is in the map (open and explored directions)."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        rng: np.random.Generator,
        whereabouts: Whereabouts | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher, self._rng = profile, maps, matcher, rng
        experience = EdgeExperience(profile, maps)
        self._directions = AllowedDirections(maps)
        self._views = FloorViews(profile.sensing.robot_slim_m)
        self._destination = FrontierDestination(
            profile, maps, matcher, experience, self._directions, self._views
        )
        self._travel = Travel(profile, maps, matcher, self._destination, experience, whereabouts)
        self._departure: Departure | None = None
        self._heading_rad = 0.0
        self._told_m = 0.0
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One frame: map, depart, or travel to the next frontier."""
        graph = self._maps.graph
        self._heading_rad = observation.moved.direction(self._heading_rad)
        if not graph.nodes:
            return self._first(observation)
        if self._departure is not None:
            return self._go_on(observation, self._departure)
        here = self._travel.tracker.here
        if self._travel.state is not State.FOLLOWING and not self._destination.choose(here):
            allowed = " that the rules allow" if open_directions(graph) else ""
            why = f"nothing unexplored is left{allowed}: {len(graph.nodes)} nodes, {len(graph.edges)} edges"
            return Decision("hold", why=why, outcome="succeeded")
        decision = self._travel.step(observation)
        self.progress = self._travel.progress
        if self._travel.state is State.ARRIVED:
            return self._arrived(observation, decision.notes)
        return decision

    def _first(self, observation: Observation) -> Decision:
        """The only node: random heading (thesis section 4.2)."""
        node_id, _ = add_node(self._maps, observation, NewEdges(), self._profile, None, self._views)
        self._head(float(self._rng.uniform(-math.pi, math.pi)))
        note = Note("node_added", "first node of the map", {"node": node_id})
        return self._leave(Displacement(node_id), (note,))

    def _arrived(self, observation: Observation, notes: tuple[Note, ...]) -> Decision:
        """At a node with a frontier: what the map has grown by since it was made may have closed some."""
        node_id = self._destination.reached
        count = self._profile.mapping.edge_candidates
        around = nodes_nearby(self._maps.graph, Displacement(node_id), self._profile, count)
        matches = self._matcher.match(around, count)
        here = self._travel.tracker.standing_at(node_id, matches)
        closed = close_known_directions(self._maps, observation, matches, self._profile, here)
        return self._leave(here, (*notes, *closed))

    def _leave(self, here: Displacement, notes: tuple[Note, ...]) -> Decision:
        """Start a departure from a node the robot stands at, or hold when it has no frontier."""
        node_id, yaw_rad = here.node_id, -here.yaw_rad
        self._travel.set_out(here)
        sectors = self._directions.of(node_id)
        preferred_rad = self._heading_rad - yaw_rad
        graph = self._maps.graph
        sector = best_sector(graph, node_id, sectors, preferred_rad, self._profile, self._views)
        if sector is None:
            return Decision("hold", why=f"node {node_id} has no unexplored direction", notes=notes)
        heading_rad = math.remainder(sector_rad(sector) + yaw_rad, math.tau)
        self._departure = Departure(
            self._profile, self._maps, self._matcher, sector, heading_rad, here, self._views
        )
        self._head(heading_rad)
        why = f"leaving node {node_id} by direction {sector}"
        return Decision("go", heading_rad, method="frontier", why=why, notes=notes)

    def _go_on(self, observation: Observation, departure: Departure) -> Decision:
        self._travel.observe(observation)
        rule = self._directions.ahead(departure.here.moved(observation.moved), departure.heading_rad)
        if rule:
            return self._turn_back(departure, observation, rule)
        result = departure.step(observation)
        self.progress = departure.progress
        if departure.unseen and self._travel.tracker.was_carried():
            self._departure = None
            self._travel.tracker.stand_at(None)
            return Decision("hold", why="this is another place than a moment ago: looking where I am")
        if isinstance(result, NewNode):
            self._departure = None
            self._head(departure.heading_rad)
            return self._leave(
                Displacement(result.node_id), (*result.notes, *self._surroundings(result.node_id))
            )
        if departure.done:
            self._departure = None
            self._travel.tracker.stand_at(departure.here)
        return result

    def _turn_back(self, departure: Departure, observation: Observation, rule: str) -> Decision:
        """A keep-out lies ahead: this direction is none for this mission."""
        self._directions.refuse(departure.node_id, departure.sector)
        self._departure = None
        self._travel.tracker.stand_at(departure.here.moved(observation.moved))
        why = f"node {departure.node_id} direction {departure.sector}: rule {rule!r} is against going on"
        return Decision("hold", why=why, notes=(Note("ruled_out", why),))

    def _surroundings(self, node_id: int) -> tuple[Note, ...]:
        """What driving has told of this place, where that is news: a room, a hall, a yard."""
        graph, told_m = self._maps.graph, self._told_m
        carries_m = half_m(graph, node_id)
        if len(graph.nodes) < TELLING_NODES or (told_m and 1 / NEWS < carries_m / told_m < NEWS):
            return ()
        self._told_m = carries_m
        times = openness(graph, node_id)
        why = f"half of the matches are lost after {carries_m:.2f} m: views carry {times:.1f} times a room's"
        return (Note("surroundings", why, {"half_m": round(carries_m, 3), "openness": round(times, 2)}),)

    def _head(self, heading_rad: float) -> None:
        """Remember where a departure led: the next one goes on about that way, a lost robot goes back."""
        self._heading_rad = self._travel.last_heading_rad = heading_rad


def _make(context: MissionContext, parameters: ExploreParameters) -> Mission:
    profile = context.profile
    if parameters.covers_m is not None and profile.mapping.covers_m != 0.0:
        profile = profile.replaced(covers_m=parameters.covers_m)
    robot = (profile, context.maps, context.matcher, context.rng)
    if profile.mapping.exploration == "strategies":
        if forbidden := context.maps.limits().forbidden:
            rule = next(iter(forbidden.values()))
            raise MissionError(f"this profile explores at random, which rule {rule!r} forbids", "forbidden")
        return ThesisExploration(*robot)
    return FrontierExploration(*robot, context.whereabouts)


KIND = MissionKind(
    name="explore",
    title="Explore",
    parameters=ExploreParameters,
    make=_make,
    shown=("nodes", "edges", "open_directions"),
    makes_map=True,
)
