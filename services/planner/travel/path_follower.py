"""Following a path: which waypoint to aim at, and what ends it early."""

import math
from collections.abc import Collection

from services.planner.ports import Decision, MapAccess, Matcher, Matches, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, similarity
from services.planner.surroundings import is_half_clear
from services.planner.travel.destination import Destination
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.last_leg import reckoned_rad
from services.planner.travel.states import Event
from services.planner.travel.steady_heading import SteadyHeading
from services.planner.travel.tracking import Tracker
from services.planner.travel.waypoints import (
    has_arrived,
    is_at,
    is_near_end,
    is_strict,
    may_advance,
    speed_fraction,
    way_left_m,
)
from shared.mapgraph.graph import EdgeKey, edge_key
from shared.mapgraph.local.keep_clear import clear_nodes, is_near_forbidden
from shared.mapgraph.routing import GOAL
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

WINDOW = 4
"""Waypoints compared at each step; chosen: nodes lie 0.7 m apart and are recognised up to some 2.5 m away."""

STUCK_STEPS = 35
"""Steps without coming closer after which no progress is made; chosen: 4.2 m at 0.12 m a step, further than
the way round any one piece of furniture."""

CLOSER = 0.95
"""Share of the least disparity so far that counts as closer, as do matches the other way round: along a
corridor disparity tells little. Chosen: one step of 0.12 m from 2.4 m away."""

WAITING_STEPS = 8
"""Steps at a waypoint after which the next one should have shown; chosen: 2.4 s, in which a person has
passed."""

NEAREST_STEPS = 8
"""Steps without coming closer after which a spot within `near_rad` is as near as obstacles allow; chosen: 2.4
s."""


BLIND_FRAMES = 40
"""Frames in which a goal is headed for that does not show; chosen: 4.8 m in a room, further than any picture
that is located in the map lies from its node."""

BESIDE = 3
"""Nodes around the robot that are compared beside those ahead; chosen: they alone tell a corridor whose doors
repeat from itself one door further, for those ahead look the same there."""


class PathFollower:
    """Drives along `path` (node ids; GOAL may be last) and looks ahead along it."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        path: list[int],
        destination: Destination,
        unclear: Collection[EdgeKey],
        experience: EdgeExperience,
        tracker: Tracker,
    ) -> None:
        self._profile, self._maps, self._destination = profile, maps, destination
        self._unclear, self._experience, self._tracker = unclear, experience, tracker
        self.path, self.index = path, 0
        self._strict = is_strict(profile)
        self._unseen_frames = 0.0
        self._share = 1.0
        self._heading_rad: float | None = None
        self._steady = SteadyHeading()
        self._best_rad, self._best_s = math.inf, 0
        self._stale = self._waiting = self._blind_frames = 0.0
        self.progress = Progress(via_points=tuple(path))

    def step(self, observation: Observation, matcher: Matcher) -> tuple[Event | None, Decision]:
        """Compare with the next waypoints, advance, and head for the present one.

        Returns:
            What ended the path, None while it goes on; and what to do for this frame.
        """
        self._turn(observation)
        matches = self._compare(matcher)
        notes = self._advance(matches, observation.ranges)
        waypoint = self.path[self.index]
        match, name = matches.get(waypoint), _name(waypoint)
        s_cv = similarity(match, self._profile) if match is not None else 0
        self._report(waypoint, s_cv, match)
        if self._has_arrived(match):
            return Event.REACHED, _hold(f"arrived at {name}, S {s_cv}", notes)
        if self._next_is_unclear(match, matches, observation.ranges):
            return Event.WAY_UNCLEAR, _hold(f"no free ground seen beyond {name}", notes)
        if self._waits_too_long(match) and not self._goes_on_blind():
            return Event.NO_PROGRESS, _hold(f"at {name}, {_name(self.path[self.index + 1])} unseen", notes)
        found = heading_of(match, self._profile) if match is not None else None
        if found is None and self._waiting:
            return None, _hold(f"at {name}, S {s_cv}", notes)
        if match is None or found is None or s_cv < self._profile.travel.s_via_min:
            return self._unseen(name, s_cv, notes)
        self._unseen_frames = 0.0
        self._heading_rad, method = self._steadied(waypoint, found[0], s_cv), found[1]
        if self._no_progress(match):
            if self._near_end(match):
                return Event.REACHED, _hold(f"as near to {name} as obstacles allow, S {s_cv}", notes)
            return Event.NO_PROGRESS, _hold(f"no progress towards {name}", notes)
        slow = self._at_end() and self._destination.arrival_rad > 0.0
        left_m = way_left_m(match, self._maps.graph)
        speed = speed_fraction(left_m - observation.since.way_m) if slow and left_m is not None else 1.0
        why = f"to {name}, S {s_cv}"
        return None, Decision("go", self._heading_rad, s_cv, speed, method, why, notes, distance_m=left_m)

    def _turn(self, observation: Observation) -> None:
        """Directions are kept in the robot's frame, which turned; turns on the spot cost little patience."""
        self._share = observation.frame_share
        self._steady.turned(observation.moved.turn_rad)
        if self._heading_rad is not None:
            self._heading_rad = observation.moved.direction(self._heading_rad)

    def failed_edge(self) -> tuple[EdgeKey | None, int]:
        """What stopped the robot: the edge driven and its waypoint; at a waypoint, what comes next."""
        if self._waiting > WAITING_STEPS:
            return self.next_edge(), self.path[self.index + 1]
        return self._current_edge(), self.path[self.index]

    def next_edge(self) -> EdgeKey:
        """The edge from the present waypoint to the one after it."""
        return edge_key(*self.path[self.index : self.index + 2])

    def leg(self) -> tuple[int, int]:
        """The node left and the waypoint aimed at; twice the same before the first."""
        return self.path[max(0, self.index - 1)], self.path[self.index]

    def _current_edge(self) -> EdgeKey | None:
        """The edge being driven; None at index 0, where there is none (thesis equation 6.4)."""
        return edge_key(*self.path[self.index - 1 : self.index + 1]) if self.index else None

    def _is_at(self, match: NodeMatch | None) -> bool:
        """Whether the robot stands at the present waypoint."""
        return is_at(match, self._maps.graph, self._profile) and not self._is_beyond()

    def _has_arrived(self, match: NodeMatch | None) -> bool:
        if match is None or not self._at_end() or self._is_beyond():
            return False
        return has_arrived(match, self._maps.graph, self._profile, self._destination.arrival_rad)

    def _is_beyond(self) -> bool:
        """Whether what the robot did says that it is not at the present waypoint; the thesis does not ask."""
        return not self._strict and self._tracker.is_beyond(self.path[self.index])

    def _at_end(self) -> bool:
        return self.index == len(self.path) - 1

    def _next_is_unclear(self, here: NodeMatch | None, seen: Matches, ranges: Ranges) -> bool:
        """At a waypoint with no sight of free ground to the next: ask for another way, once."""
        standing = not (self._strict or self._at_end()) and self._is_at(here)
        return standing and not self._next_is_known(seen.get(self.path[self.index + 1]), ranges)

    def _next_is_known(self, there: NodeMatch | None, ranges: Ranges) -> bool:
        """Driven before, seen free before and not shut now, or no other way was left when it was unclear."""
        edge = self._maps.graph.edge(*self.next_edge())
        if self.next_edge() in self._unclear or (edge is not None and edge.traversals > 0):
            return True
        if edge is None or not edge.clear or there is None:
            return False
        return is_half_clear(there, self._maps.graph, ranges, self._profile)

    def _compare(self, matcher: Matcher) -> dict[int, NodeMatch]:
        window = dict.fromkeys(self.path[self.index : self.index + WINDOW])
        ahead = [node for node in window if node != GOAL]
        picture = self._destination.picture
        nodes = [*ahead, *(node for node in self._tracker.nearby()[:BESIDE] if node not in ahead)]
        seen = matcher.match(nodes, targets=() if picture is None else (picture,))
        goal = {GOAL: seen.pop(GOAL)} if GOAL in seen else {}
        possible = self._tracker.possible(seen)
        self._tracker.confirm(possible)
        if goal:
            self._destination.sees(goal[GOAL], self._tracker.here)
        return {**possible, **goal}

    def _advance(self, matches: dict[int, NodeMatch], ranges: Ranges) -> tuple[Note, ...]:
        """Go on to the latest waypoint that may be headed for; by the thesis only to the next."""
        here = matches.get(self.path[self.index])
        reach = WINDOW - 1 if self._destination.cuts_corners and not self._strict else 1
        for later in range(min(self.index + reach, len(self.path) - 1), self.index, -1):
            there = matches.get(self.path[later])
            if there is None or not self._may_advance(here, there, later, ranges):
                continue
            learnt = self._mark_driven(here)
            self._head_for(later)
            s_here = similarity(here, self._profile) if here is not None else 0
            s_there = similarity(there, self._profile)
            values = {"s_cv": s_here, "s_nv": s_there, "via": self.path[later]}
            return (*learnt, Note("via_advanced", f"next waypoint {_name(self.path[later])}", dict(values)))
        return ()

    def _head_for(self, index: int) -> None:
        """Make another waypoint the present one, of which no progress is known yet."""
        self.index, self._best_rad, self._best_s, self._stale = index, math.inf, 0, 0.0

    def _may_advance(self, here: NodeMatch | None, there: NodeMatch, later: int, ranges: Ranges) -> bool:
        beside = later == self.index + 1 and self._is_at(here)
        if not beside and (not self._destination.cuts_corners or self._crosses_keep_out(self.path[later])):
            return False
        aliased_goal = self._destination.aliased and self.path[later] == GOAL
        return may_advance(
            here,
            there,
            self._maps.graph,
            ranges,
            self._profile,
            straight=beside or not aliased_goal,
            beside=beside and self._next_is_known(there, ranges),
        )

    def _crosses_keep_out(self, waypoint: int) -> bool:
        """Whether the short way to a later waypoint leads where the path goes round."""
        forbidden, here, graph = self._maps.limits().forbidden, self._tracker.here, self._maps.graph
        if not forbidden:
            return False
        if waypoint == GOAL or here is None:  # where they are is not sure enough to cut a corner
            return is_near_forbidden(graph, here, forbidden)
        return waypoint not in clear_nodes(graph, here, [waypoint], forbidden)

    def _mark_driven(self, match: NodeMatch | None) -> tuple[Note, ...]:
        """The robot stands at a waypoint: the edge to it has been driven."""
        edge = self._current_edge()
        if edge is None or GOAL in edge or not self._is_at(match):
            return ()
        note = self._experience.driven(edge, match)
        return () if note is None else (note,)

    def _steadied(self, waypoint: int, seen_rad: float, s_cv: int) -> float:
        if self._strict:
            return seen_rad
        return self._steady.follow(waypoint, seen_rad, close=s_cv >= self._profile.mapping.s_node_max)

    def _unseen(self, name: str, s_cv: int, notes: tuple[Note, ...]) -> tuple[Event | None, Decision]:
        """The waypoint is not seen: to a goal by the map, else on for a few frames; then it is lost."""
        blind_rad = self._blind_rad() if self.path[self.index] == GOAL else None
        if blind_rad is not None:
            self._heading_rad = blind_rad
            why = f"{name} not seen, S {s_cv}: to where the map has it"
            return None, Decision("go", blind_rad, s_cv, 1.0, "reckoned", why, notes)
        self._unseen_frames += self._share
        if self._unseen_frames >= self._profile.travel.suspend_after or self._heading_rad is None:
            return Event.WAYPOINT_LOST, _hold(f"{name} not seen, S {s_cv}", notes)
        why = f"{name} not seen for {self._unseen_frames:.0f} frames, keeping on"
        return None, Decision("go", self._heading_rad, s_cv, 1.0, "previous", why, notes)

    def _goes_on_blind(self) -> bool:
        """Whether the goal, which does not show from the last node, is headed for by where the map has it."""
        blind = self.path[self.index + 1] == GOAL and self._blind_rad() is not None
        if blind:
            self._head_for(self.index + 1)
            self._waiting = 0.0
        return blind

    def _blind_rad(self) -> float | None:
        """Bearing of the goal by the map; None where that is not known, and after so many frames."""
        if self._strict or len(self.path) < 2:
            return None
        self._blind_frames += self._share
        if self._blind_frames > BLIND_FRAMES:
            return None
        return reckoned_rad(self._maps.graph, self._tracker.here, self._destination.lies(self.path[-2]))

    def _no_progress(self, match: NodeMatch) -> bool:
        disparity = match.disparity_rad if match.disparity_rad is not None else 0.0
        s_cv = similarity(match, self._profile)
        nearer, liker = disparity < self._best_rad * CLOSER, s_cv * CLOSER > self._best_s
        self._best_rad = disparity if nearer else self._best_rad
        self._best_s = s_cv if liker else self._best_s
        self._stale = 0.0 if nearer or liker else self._stale + self._share
        return self._stale > (NEAREST_STEPS if self._near_end(match) else STUCK_STEPS)

    def _waits_too_long(self, match: NodeMatch | None) -> bool:
        """At a waypoint from which the next one does not show: what leads there is shut."""
        standing = not (self._strict or self._at_end()) and self._is_at(match)
        self._waiting = self._waiting + self._share if standing else 0.0
        return self._waiting > WAITING_STEPS

    def _near_end(self, match: NodeMatch) -> bool:
        return self._at_end() and is_near_end(
            match, self._maps.graph, self._profile, self._destination.arrival_rad
        )

    def _report(self, waypoint: int, s_cv: int, match: NodeMatch | None) -> None:
        disparity = match.disparity_rad if match is not None else None
        nearest = waypoint if waypoint != GOAL else None
        self.progress = Progress(tuple(self.path), self.index, nearest, s_cv, disparity)


def _hold(why: str, notes: tuple[Note, ...]) -> Decision:
    return Decision("hold", why=why, notes=notes)


def _name(node_id: int) -> str:
    return "the goal" if node_id == GOAL else f"node {node_id}"
