"""The destination of a goto: where a picture was taken (thesis sections 4.1 and 4.3)."""

from collections.abc import Iterator, Mapping

from services.planner.goals.candidates import SPOT_M, Candidates
from services.planner.goals.place_evidence import Visit
from services.planner.goals.places import GoalPlaces, Ruling
from services.planner.goals.setbacks import Setbacks
from services.planner.mapping.reach import claims
from services.planner.ports import MapAccess, Matcher, Matches, Note
from services.planner.profiles import Profile
from services.planner.similarity import similarity as similarity_of
from services.planner.similarity import trusted
from services.planner.surroundings import is_clear, is_clear_from
from services.planner.travel.destination import Setback, Verdict
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.following.last_leg import reckoned
from services.planner.travel.localisation import reachable_nodes
from services.planner.travel.states import Event
from services.planner.travel.tracking import Tracker
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.graph import edge_key
from shared.mapgraph.local.displacement import Displacement, seen_from
from shared.mapgraph.local.hypotheses import COMPARED_NODES, SPREAD
from shared.mapgraph.routing import GOAL
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges

COMPARED = 8
"""Nodes compared to localise a frame; chosen: about the neighbours of a node of the apartment's map."""

CLOSER_SHARE = 0.5
"""Of the disparity that is arrival, where places look alike: 5 cm from the spot the same room differs as a
picture by 20 levels, 10 cm from it by as many as the next room, 40."""

CLOSEST_SHARE = 0.6
"""Of that disparity what is arrival for another look: 3 cm from the spot instead of 5. Chosen: of two looks
from as far the second tells as much as the first."""

SEARCH_STEPS = 150
"""Steps of searching before the mission ends as lost (decision 0014)."""

LAST_EDGE_M = 6.0
"""Added to the way from a last node from which the goal was not found; chosen: its other sides come first."""

GOAL_SHARE = 0.6
"""Least similarity of an arrival relative to that of the most similar node: where the goal picture was taken,
nothing resembles the view more than the goal does. Of 75 arrivals in three worlds the right ones had S 159
and more, the one aliased 31."""


class GoalDestination:
    """Where a picture was taken: the nodes it resembles, and what was learnt on the way there.

    A picture of the map's own was taken at its node, however many places look alike, and the way leads there.
    But a robot that guessed at which of them it is cannot go by the map: then it asks where the picture is.

    Args:
        profile: thresholds.
        maps: the map.
        matcher: compares frames.
        goal: the picture.
        experience: what this mission learns of edges.
        whereabouts: of the robot.
        node: whose picture it is; None where nobody knows.
    """

    compared, search_steps = COMPARED, SEARCH_STEPS
    cuts_corners = True

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        goal: Features,
        experience: EdgeExperience,
        whereabouts: Whereabouts,
        node: int | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._experience, self._at, self._node = experience, whereabouts, node
        self.picture: Features | None = goal
        self._failure: tuple[FailureKind, str] = ("goal_not_in_map", "the goal resembles no node of the map")
        self._setbacks = Setbacks(profile, maps, experience)
        self._look(goal)

    def _look(self, goal: Features) -> None:
        """Find the picture about its node, or in the whole map."""
        maps, profile = self._maps, self._profile
        if self._node in maps.graph.nodes:
            found = self._matcher.locate(goal, 0, (self._node, *maps.graph.neighbours(self._node)))
        else:
            self._node = None
            found = self._matcher.locate(goal, COMPARED_NODES)
        self.candidates = Candidates(maps, found, profile)
        if len(self.candidates.places) > 1:
            to_look_at = self.candidates.to_look_at()
            self.candidates.look(self._matcher.locate(goal, 0, to_look_at, with_differences=True))
        self.places = GoalPlaces(self.candidates, self._at.look_alikes)
        plain, strict = self.candidates.plain, profile.sensing.similarity == "raw"
        self.aliased = not plain or (self._node is not None and not strict)  # its look-alikes are not known
        self.arrival_rad = self._arrival_rad()
        self._lies = dict(self._seen_from(found))
        self._targets = self._reachable(found)
        self._targets |= dict.fromkeys(self.places.without(self._targets), LAST_EDGE_M)

    def located(self) -> Note:
        """Where the picture was taken, as far as is known."""
        where = f"goal resembles nodes {sorted(self.targets())}"
        if self._node is not None:
            where = f"goal is node {self._node}"
        doubt = "" if self.candidates.plain else f"; places of nodes {self.candidates.names} look alike"
        return Note("goal_located", where + doubt)

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
        closed, avoided = self._experience.unreachable, self._setbacks.avoided
        return {node: c + avoided.get(node, 0.0) for node, c in visible.items() if node not in closed}

    def goes_straight(self) -> bool:
        """Not once it got stuck, for what shut the way is still there, nor once it went to a look-alike.

        After it was lost on such a way it goes a part of it by the map first.
        """
        return self.candidates.plain and not self._setbacks.any_on_a_straight_way

    def sees(self, goal: NodeMatch, here: Displacement | None) -> bool:
        """What tells places apart is looked for in every frame; a look-alike is not gone by."""
        self.places.sees(goal, here)
        return not self.candidates.is_elsewhere(goal, here)

    def lies(self, node_id: int) -> Displacement | None:
        """Where the picture was taken, relative to a node that it resembles."""
        return self._lies.get(node_id)

    def set_out(self) -> None:
        """There is a path by the map."""
        self._setbacks.strayed = False

    def localised(self, seen: Matches, ranges: Ranges) -> tuple[Note, ...]:
        """What localisation says about edges: one that just failed, suspended ones that are seen free."""
        sure = {node: match for node, match in seen.items() if trusted(match, self._profile)}
        notes = [*self._doubted(), *self._setbacks.judge_suspect(sure)]
        for near in (node for node, match in sure.items() if match.status == "no_baseline"):
            for far, match in sure.items():
                if far != near and is_clear(match, self._maps.graph, ranges, self._profile):
                    note = self._experience.seen_free(edge_key(near, far), match)
                    notes += [] if note is None else [note]
        return tuple(notes)

    def mistaken(self) -> tuple[Note, ...]:
        """The places that it visited were others: it begins anew with the goal's."""
        assert self.picture is not None
        self._setbacks.mistaken()
        self._look(self.picture)
        return (
            Note("mistaken", "not where it believed to be: places are visited anew"),
            self.located(),
        )

    def no_path(self) -> Verdict:
        """Lift all bans once; then, or when nothing is banned for long, give up."""
        return self._setbacks.no_path()

    def setback(self, setback: Setback) -> Verdict:
        """Blame the edge or the waypoint that failed; a goal that was missed says something of its place."""
        edge, waypoint = setback.edge, setback.waypoint
        if waypoint == GOAL and edge is not None and setback.path[-2] in self._targets:
            self._targets[setback.path[-2]] += LAST_EDGE_M
        if waypoint == GOAL:
            self._settle(self._place_missed(setback))
        verdict = self._setbacks.count(setback)
        shut = self.places.way_failed(waypoint)
        if shut is None:
            return verdict
        self._settle(shut)
        self._setbacks.begin_anew()
        return Verdict((*verdict.notes, Note("place_shut", shut.why)))

    def _place_missed(self, setback: Setback) -> Ruling:
        """What it says of the place headed for that the robot did not arrive there."""
        node = setback.path[-2] if len(setback.path) > 1 else None
        if setback.event is Event.ALIASED:
            return Ruling("judged on arrival")
        if setback.event is Event.WAYPOINT_LOST:
            return self.places.lost(node)
        return self.places.stood(node) if self.candidates.is_at(setback.here) else self.places.blocked(node)

    def refutes_arrival(self, end: int, similarity: int, tracker: Tracker) -> str:  # noqa: ARG002
        """Whether another node resembles the view more than the goal does; the thesis does not ask."""
        if self._profile.travel.path_cost == "nodes":
            return ""
        assert self.picture is not None
        self._doubted()
        view = self._matcher.match([], COMPARED_NODES, (self.picture,))
        view.pop(GOAL, None)
        node = tracker.here.node_id if tracker.here is not None else None
        s_map = max((similarity_of(match, self._profile) for match in view.values()), default=0)
        if similarity < GOAL_SHARE * s_map:
            self.aliased = True
            tracker.shown(view)
            if self.candidates.plain and not tracker.mistaken:
                self._rule_out(view, tracker.here)
            elif not tracker.mistaken:
                self._settle(self.places.refuted(tracker.here))
            return f"aliased: a node of the map resembles this view more than the goal does, S {s_map}"
        if another := self.candidates.shows_another(view, tracker.here):
            self.aliased = True
            tracker.shown(view)
            return f"aliased: this is about node {another.nodes[0]}, its place about {self.candidates.names}"
        why = self._settle(self.places.arrived(node, Visit(similarity, tracker.likeness(similarity))))
        self._at.guessed = self._at.guessed and bool(why)
        return why

    def _doubted(self) -> tuple[Note, ...]:
        """Who is where it is by a guess cannot go by the map alone: the picture may be of any look-alike."""
        if self._node is None or not self._at.guessed or self.picture is None:
            return ()
        self._node = None
        self._look(self.picture)
        return (self.located(),)

    def _settle(self, ruling: Ruling) -> str:
        """Take over what the places say: without any left there are no targets."""
        self.arrival_rad = self._arrival_rad()
        if ruling.failure:
            self._failure, self._targets = (ruling.failure, ruling.why), {}
        return ruling.why

    def _arrival_rad(self) -> float:
        """Disparity that is arrival: less where places look alike, and least for another look."""
        share = 1.0 if self.candidates.plain else CLOSER_SHARE
        share *= CLOSEST_SHARE if self.places.looks_again else 1.0
        return self._profile.arrival.arrival_rad * share

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

    def _rule_out(self, view: Matches, here: Displacement | None) -> None:
        """This is not where the picture was taken: nor is it where nodes put it that put it here.

        Along a fence the next node of the right place may be in view, two metres on. Where nobody knows where
        a node puts the picture it is not beside those in view.
        """
        seen = {node for node, match in view.items() if trusted(match, self._profile)}

        def is_out(node: int) -> bool:
            spot = reckoned(self._maps.graph, here, self._lies.get(node))
            return node in seen if spot is None else spot[1] < SPOT_M

        self._targets = {n: cost for n, cost in self._targets.items() if not is_out(n)} or self._targets
