"""Mission route: to the first node of a taught route, then along exactly its nodes, there or back."""

from dataclasses import replace

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.ports import Decision, MapAccess, Note, Observation, Progress
from services.planner.routes.destination import RouteDestination
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.machine import Travel
from services.planner.travel.states import State
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.marks import gaps, route_called
from shared.messages.places import PlaceName

TOLD = 8
"""Nodes left out that the reason names; chosen: the text stays a line."""


class RouteParameters(BaseModel):
    """Which route, which way, how often."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    route: PlaceName = Field(description="The name of a route of the map.")
    reverse: bool = Field(default=False, description="From its end to its beginning.")
    rounds: int = Field(default=1, ge=0, le=100_000, description="0: until it is cancelled.")


class Checkpoint(BaseModel):
    """What a planner that restarts goes on from.

    Attributes:
        round: the one under way, from 1.
        at: index of the node to reach next, in the order of driving.
        left_out: the first nodes that were not reached, as many as are told; left_out_in_all: how many.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    round: int = Field(default=1, ge=1)
    at: int = Field(default=0, ge=0)
    left_out: tuple[int, ...] = ()
    left_out_in_all: int = Field(default=0, ge=0)


class FollowRoute:
    """Follows the nodes in order; `begun` is where an earlier planner had got to."""

    def __init__(
        self, context: MissionContext, parameters: RouteParameters, nodes: tuple[int, ...], begun: Checkpoint
    ) -> None:
        self._maps, self._parameters, self._begun = context.maps, parameters, begun
        self._round = begun.round
        experience = EdgeExperience(context.profile, context.maps)
        robot = (context.profile, context.maps, context.matcher)
        self._destination = RouteDestination(*robot, experience, nodes, min(begun.at, len(nodes) - 1))
        self._travel = Travel(*robot, self._destination, experience, context.whereabouts)

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        at = self._at()
        figures: dict[str, float | int | str | bool | None] = {
            "round": at.round,
            "passed": at.at,
            "of": len(self._destination.nodes),
            "left_out": at.left_out_in_all,
        }
        return replace(self._travel.progress, figures=figures, checkpoint=at.model_dump(mode="json"))

    def decide(self, observation: Observation) -> Decision:
        """One frame along the route."""
        if rule := against(self._maps, self._destination.nodes, self._destination.at):
            why = f"rule {rule!r} is against going on along route {self._parameters.route!r}"
            return Decision("hold", why=why, outcome="failed", failure="forbidden")
        decision = self._travel.step(observation)
        if self._travel.state is State.FOLLOWING:
            self._destination.follow(self._travel.progress)
        return self._arrive(decision) if self._travel.state is State.ARRIVED else decision

    def _arrive(self, decision: Decision) -> Decision:
        """At the end of a path: of the route, of a round, or where an edge is shut."""
        end = self._destination.nodes[self._destination.at]
        note = self._destination.arrived()
        if note is not None:
            self._travel.set_out(self._travel.tracker.here or Displacement(end))
            return replace(decision, why=note.reason, notes=(*decision.notes, note))
        rounds, name = self._parameters.rounds, self._parameters.route
        driven = Note("round_driven", f"round {self._round} of route {name!r}", {"round": self._round})
        decision = replace(decision, notes=(*decision.notes, driven))
        if rounds and self._round >= rounds:
            return replace(decision, why=self._told(), outcome="succeeded")
        self._round += 1
        self._destination.begin_again()
        self._travel.set_out(self._travel.tracker.here or Displacement(end))
        return decision

    def _told(self) -> str:
        at, name = self._at(), self._parameters.route
        told = f"route {name!r} driven, rounds: {at.round}"
        if not at.left_out_in_all:
            return told
        return f"{told}; left out {at.left_out_in_all} times, nodes {list(at.left_out)}"

    def _at(self) -> Checkpoint:
        left_out = self._destination.left_out
        return Checkpoint(
            round=self._round,
            at=self._destination.at,
            left_out=(*self._begun.left_out, *left_out)[:TOLD],
            left_out_in_all=self._begun.left_out_in_all + len(left_out),
        )


def against(maps: MapAccess, nodes: tuple[int, ...], at: int = 0) -> str:
    """Name of the rule against driving along nodes in their order, from one on; "" without any."""
    limits = maps.limits()
    if not limits:
        return ""
    forbidden = (limits.forbidden[node] for node in nodes[at:] if node in limits.forbidden)
    return next(forbidden, "") or limits.against_path(nodes[max(0, at - 1) :])


def _make(context: MissionContext, parameters: RouteParameters) -> FollowRoute:
    maps = context.maps
    route = route_called(parameters.route, maps.graph.routes)
    if isinstance(route, str):
        raise MissionError(route, "missing")
    if missing := gaps(route, maps.graph.edges):
        a, b = missing[0]
        why = f"route {route.name!r} is broken: no edge joins nodes {a} and {b} any more; teach it anew"
        raise MissionError(why, "conflict")
    if len(route.nodes) < 2:
        raise MissionError(f"route {route.name!r} has lost its nodes: teach it anew", "missing")
    nodes = route.nodes[::-1] if parameters.reverse else route.nodes
    begun = Checkpoint.model_validate(context.checkpoint)
    if not context.checkpoint and (rule := against(maps, nodes)):
        raise MissionError(f"route {route.name!r} is forbidden by rule {rule!r}", "forbidden")
    return FollowRoute(context, parameters, nodes, begun)


KIND = MissionKind(
    name="route",
    title="Drive along a route",
    parameters=RouteParameters,
    make=_make,
    shown=("round", "passed", "of", "left_out"),
)
