"""Mission goto: drive to where a picture was taken (thesis sections 4.1 and 4.3)."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from pydantic import BaseModel, ConfigDict, Field

from services.planner.goal_nodes import check_allowed, node_called
from services.planner.mapping.reach import claims
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.photographs.photo_goto import PhotoGoto
from services.planner.ports import (
    Decision,
    MapAccess,
    Matcher,
    Matches,
    Mission,
    Note,
    Observation,
    Progress,
)
from services.planner.profiles import Profile
from services.planner.similarity import ranked, trusted
from services.planner.similarity import similarity as similarity_of
from services.planner.surroundings import is_clear, is_clear_from
from services.planner.travel.destination import Setback, Verdict
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.goal_places import GoalPlaces, Ruling
from services.planner.travel.localisation import reachable_nodes
from services.planner.travel.machine import Travel
from services.planner.travel.place_evidence import Visit
from services.planner.travel.states import Event, State
from services.planner.travel.tracking import Tracker
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.graph import EdgeKey, edge_key
from shared.mapgraph.local.displacement import Displacement, seen_from
from shared.mapgraph.local.hypotheses import COMPARED_NODES, SPREAD
from shared.mapgraph.routing import GOAL
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.places import PlaceName
from shared.messages.sensors import Ranges

COMPARED = 8
"""Nodes compared to localise a frame; chosen: about the neighbours of a node of the apartment's map."""

LOST_MAX = 12
"""Times a mission may lose its waypoint; chosen: more than any round of `topnav hide-and-seek` needed."""

STUCK_MAX = 8
"""Times it may come no nearer to one; chosen alike."""

CLOSER_SHARE = 0.5
"""Of the disparity that is arrival, where places look alike: 5 cm from the spot the same room differs as a
picture by 20 levels, 10 cm from it by as many as the next room, 40."""

REFUTED_MAX = 16
"""Arrivals that may turn out to be none; chosen: two at each of as many places as are ever named."""

SEARCH_STEPS = 150
"""Steps of searching before the mission ends as lost (decision 0014)."""

AVOID_M = 3.0
"""Added to the cost of starting at a waypoint that failed; chosen: another node as near comes first."""

LAST_EDGE_M = 6.0
"""Added to the way from a last node from which the goal was not found; chosen: its other sides come first."""

GOAL_SHARE = 0.6
"""Least similarity of an arrival relative to that of the most similar node: where the goal picture was taken,
nothing resembles the view more than the goal does. Of 75 arrivals in three worlds the right ones had S 159
and more, the one aliased 31."""


class GotoParameters(BaseModel):
    """Goal of a goto without a picture: one of them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    goal_node: int | None = Field(default=None, ge=0, lt=2**63, description="A node of the map.")
    place: PlaceName | None = Field(default=None, description="The name of a place.")


class GoalDestination:
    """Where a picture was taken: the nodes it resembles, and what was learnt on the way there."""

    compared, search_steps = COMPARED, SEARCH_STEPS
    cuts_corners = True

    def __init__(
        self, profile: Profile, maps: MapAccess, matcher: Matcher, goal: Features, experience: EdgeExperience
    ) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._experience = experience
        self.picture: Features | None = goal
        self._failure: tuple[FailureKind, str] = ("goal_not_in_map", "the goal resembles no node of the map")
        found = self._matcher.locate(goal, COMPARED_NODES)
        self.places = GoalPlaces(maps, found, profile)
        self.aliased = not self.places.plain
        self.arrival_rad = profile.arrival.arrival_rad * (1.0 if self.places.plain else CLOSER_SHARE)
        self._lies = dict(self._seen_from(found))
        self._targets = self._reachable(found)
        self._targets |= dict.fromkeys(self.places.without(self._targets), LAST_EDGE_M)
        self._avoid: dict[int, float] = {}
        self._lost = self._stuck = self._refuted = 0
        self._strayed = False
        self._suspect: tuple[EdgeKey, str] | None = None
        self._relocated: set[EdgeKey] = set()

    def targets(self) -> dict[int, float]:
        """Nodes the goal resembles, with the cost of the way from each."""
        return self.places.open_targets(self._targets)

    def unreachable(self) -> tuple[FailureKind, str]:
        """The goal is not in the map, or at one of several places."""
        return self._failure

    def beyond(self, _end: int) -> tuple[int, ...]:
        """After its last node comes the picture."""
        return ()

    def starts(self, visible: Mapping[int, float]) -> dict[int, float]:
        """Without nodes that no way was found to; those that failed come later."""
        closed = self._experience.unreachable
        return {node: c + self._avoid.get(node, 0.0) for node, c in visible.items() if node not in closed}

    def goes_straight(self, goal: NodeMatch, here: Displacement | None) -> bool:
        """Not once it got stuck, for what shut the way is still there, nor once it went to a look-alike.

        After it was lost on such a way it goes a part of it by the map first.
        """
        return not (self._stuck or self._refuted or self._strayed) and self.places.may_be_seen(goal, here)

    def sees(self, goal: NodeMatch, here: Displacement | None) -> None:
        """What tells places apart is looked for in every frame."""
        self.places.sees(goal, here)

    def lies(self, node_id: int) -> Displacement | None:
        """Where the picture was taken, relative to a node that it resembles."""
        return self._lies.get(node_id)

    def set_out(self) -> None:
        """There is a path by the map."""
        self._strayed = False

    def localised(self, seen: Matches, ranges: Ranges) -> tuple[Note, ...]:
        """What localisation says about edges: one that just failed, suspended ones that are seen free."""
        sure = {node: match for node, match in seen.items() if trusted(match, self._profile)}
        notes = list(self._judge_suspect(sure))
        for near in (node for node, match in sure.items() if match.status == "no_baseline"):
            for far, match in sure.items():
                if far != near and is_clear(match, self._maps.graph, ranges, self._profile):
                    note = self._experience.seen_free(edge_key(near, far), match)
                    notes += [] if note is None else [note]
        return tuple(notes)

    def no_path(self) -> Verdict:
        """Lift all bans once; then, or when nothing is banned for long, give up."""
        self._lost += 1
        banned = len(self._experience.banned)
        why = f"no path from here to the goal, {banned} edges failed in this mission"
        if self._experience.lift_bans():
            return Verdict(notes=(Note("second_try", f"{why}: all are tried once more"),), why=why)
        if self._lost <= LOST_MAX and not banned:
            return Verdict(why=why)
        return Verdict(failure="blocked" if banned else "no_path", why=why)

    def setback(self, setback: Setback) -> Verdict:
        """Blame the edge or the waypoint that failed."""
        edge, waypoint = setback.edge, setback.waypoint
        if waypoint == GOAL and edge is not None and setback.path[-2] in self._targets:
            self._targets[setback.path[-2]] += LAST_EDGE_M
        if waypoint == GOAL:
            self._settle(self._place_missed(setback))
        self._avoid[waypoint] = self._avoid.get(waypoint, 0.0) + AVOID_M
        edge = edge if edge is None or GOAL not in edge else None
        notes: tuple[Note, ...] = (Note("replan", f"{setback.event.value}: {setback.why}"),)
        if setback.event is Event.WAYPOINT_LOST:
            self._strayed = setback.path == (GOAL,)
            if edge is not None:
                self._suspect = (edge, "lost")
            self._lost += 1
            given_up: FailureKind = "blocked" if self._experience.banned else "lost"
            return Verdict(notes, given_up if self._lost > LOST_MAX else "")
        if setback.event is Event.ALIASED:
            self._refuted += 1
            return Verdict(notes, "blocked" if self._refuted > REFUTED_MAX else "")
        self._stuck += 1
        notes += self._experience.stuck(edge, waypoint)
        return Verdict(notes, "blocked" if self._stuck > STUCK_MAX else "")

    def _place_missed(self, setback: Setback) -> Ruling:
        """What it says of the place headed for that the robot did not arrive there."""
        node = setback.path[-2] if len(setback.path) > 1 else None
        if setback.event is Event.ALIASED:
            return Ruling("judged on arrival")
        if setback.event is Event.WAYPOINT_LOST:
            return self.places.lost(node)
        return self.places.stood(node) if self.places.is_at(setback.here) else self.places.blocked(node)

    def refutes_arrival(self, end: int, similarity: int, tracker: Tracker) -> str:  # noqa: ARG002
        """Whether another node resembles the view more than the goal does; the thesis does not ask."""
        if self._profile.travel.path_cost == "nodes":
            return ""
        assert self.picture is not None
        view = self._matcher.match([], COMPARED_NODES, (self.picture,))
        view.pop(GOAL, None)
        node = tracker.here.node_id if tracker.here is not None else None
        s_map = max((similarity_of(match, self._profile) for match in view.values()), default=0)
        if similarity < GOAL_SHARE * s_map:
            self.aliased = True
            if self.places.plain:
                self._rule_out(view)
            else:
                self._settle(self.places.refuted(tracker.here))
            return f"aliased: a node of the map resembles this view more than the goal does, S {s_map}"
        if another := self.places.shows_another(view, tracker.here):
            self.aliased = True
            tracker.shown({node: view[node] for node in another.nodes})
            return f"aliased: this is about node {another.nodes[0]}, its place about {self.places.names}"
        return self._settle(self.places.arrived(node, Visit(similarity, tracker.likeness(similarity))))

    def _settle(self, ruling: Ruling) -> str:
        """Take over what the places say: without any left there are no targets."""
        if ruling.failure:
            self._failure, self._targets = (ruling.failure, ruling.why), {}
        return ruling.why

    def _seen_from(self, found: Matches) -> Iterator[tuple[int, Displacement]]:
        graph = self._maps.graph
        for node, claim in claims(graph, found, self._profile).items():
            spread_m = SPREAD * claim.length_m
            yield node, seen_from(node, claim.heading_rad, claim.yaw_rad, claim.length_m, spread_m)

    def _reachable(self, found: Matches) -> dict[int, float]:
        graph, profile = self._maps.graph, self._profile
        known = {n: m for n, m in found.items() if n in graph.nodes}
        clear = {n for n, m in known.items() if is_clear_from(graph.nodes[n], m, graph, profile)}
        return reachable_nodes(found, graph, profile, profile.mapping.s_edge_min, clear)

    def _rule_out(self, here: Matches) -> None:
        """This is not where the picture was taken: nor is that beside the nodes seen from here."""
        seen = {node for node, match in here.items() if trusted(match, self._profile)}
        elsewhere = {node: cost for node, cost in self._targets.items() if node not in seen}
        self._targets = elsewhere or self._targets

    def _judge_suspect(self, seen: Matches) -> tuple[Note, ...]:
        """A robot that finds itself far from the edge it lost was carried: that says nothing about the edge.

        Nobody carries it off the same edge twice: then the edge leads elsewhere than the map says.
        """
        if self._suspect is None or not seen:
            return ()
        (edge, why), self._suspect = self._suspect, None
        graph = self._maps.graph
        near = {*edge, *graph.neighbours(edge[0]), *graph.neighbours(edge[1])}
        best = ranked(seen, self._profile)[0][0]
        if best not in near and edge not in self._relocated:
            self._relocated.add(edge)
            return (Note("relocated", f"lost near edge {edge}, found again at node {best}"),)
        return (self._experience.failed(edge, why),)


class Goto:
    """Travels to a goal picture; ends with arrival or a typed failure."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        goal: Features,
        whereabouts: Whereabouts | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher, self._goal = profile, maps, matcher, goal
        self._whereabouts = whereabouts
        self._travel: Travel | None = None

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        return Progress() if self._travel is None else self._travel.progress

    def decide(self, observation: Observation) -> Decision:
        """One frame; in the first one the goal is located in the map."""
        if self._travel is not None:
            return self._outcome(self._travel, self._travel.step(observation))
        experience = EdgeExperience(self._profile, self._maps)
        destination = GoalDestination(self._profile, self._maps, self._matcher, self._goal, experience)
        self._travel = Travel(
            self._profile, self._maps, self._matcher, destination, experience, self._whereabouts
        )
        where = f"goal resembles nodes {sorted(destination.targets())}"
        doubt = "" if destination.places.plain else f"; places of nodes {destination.places.names} look alike"
        located = Note("goal_located", where + doubt)
        decision = self._travel.step(observation)
        return self._outcome(self._travel, replace(decision, notes=(located, *decision.notes)))

    @staticmethod
    def _outcome(travel: Travel, decision: Decision) -> Decision:
        return replace(decision, outcome="succeeded") if travel.state is State.ARRIVED else decision


def goto_place(context: MissionContext, name: str) -> Goto:
    """To the place of a name; MissionError where there is none that the rules allow."""
    goal = context.maps.features_of(node_called(context.maps, name))
    return Goto(context.profile, context.maps, context.matcher, goal, context.whereabouts)


def _make(context: MissionContext, parameters: GotoParameters) -> Mission:
    node_id, place = parameters.goal_node, parameters.place
    if sum(given is not None for given in (context.goal, node_id, place)) != 1:
        raise MissionError(
            "goto needs a goal picture's features, a goal_node or a place, exactly one of them"
        )
    if place is not None:
        node_id = node_called(context.maps, place)
    goal = context.goal
    if goal is None:
        if node_id not in context.maps.graph.nodes:
            raise MissionError(f"the map has no node {node_id}", "missing")
        check_allowed(context.maps, node_id)
        goal = context.maps.features_of(node_id)
    profile, maps, matcher = context.profile, context.maps, context.matcher
    if goal.photo is None:
        return Goto(profile, maps, matcher, goal, context.whereabouts)

    def travel_to(node: Features) -> Goto:
        return Goto(profile, maps, matcher, node, context.whereabouts)

    return PhotoGoto(profile, maps, matcher, goal, goal.photo, travel_to, context.rng)


KIND = MissionKind(
    name="goto",
    title="Drive to a picture, node or place",
    parameters=GotoParameters,
    make=_make,
    shown=("similarity",),
    takes_picture=True,
)
