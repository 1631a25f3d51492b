"""Following a path: which waypoint to aim at, and what ends it early."""

from collections.abc import Collection

from services.planner.ports import Decision, MapAccess, Matcher, Matches, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, similarity
from services.planner.travel.destination import Destination
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.following.last_leg import next_reckoned
from services.planner.travel.following.lookahead import Lookahead
from services.planner.travel.following.path_position import PathPosition
from services.planner.travel.following.patience import Patience
from services.planner.travel.following.steady_heading import SteadyHeading
from services.planner.travel.following.waypoints import (
    has_arrived,
    is_near_end,
    is_shut,
    is_strict,
    is_taken,
    speed_fraction,
    was_driven_in_vain,
    way_left_m,
)
from services.planner.travel.states import Event
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import EdgeKey
from shared.mapgraph.routing import GOAL
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges


class PathFollower:
    """Drives along `path` (node ids; GOAL may be last) and looks ahead along it.

    Attributes:
        position: where on the path the robot is.
        progress: the same for the mission's status.
    """

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
        self._experience, self._tracker = experience, tracker
        self._ahead = Lookahead(profile, maps, destination, unclear, tracker)
        self._patience = Patience()
        self.position = PathPosition(path)
        self._strict = is_strict(profile)
        self._heading_rad: float | None = None
        self._reckons = False
        self._steady = SteadyHeading()
        self.progress = Progress(via_points=tuple(path))

    def step(self, observation: Observation, matcher: Matcher) -> tuple[Event | None, Decision]:
        """Compare with the next waypoints, advance, and head for the present one.

        Returns:
            What ended the path, None while it goes on; and what to do for this frame.
        """
        self._turn(observation)
        matches = self._ahead.compare(self.position.ahead, matcher)
        notes = self._advance(matches, observation.ranges)
        waypoint = self.position.waypoint
        match, name = matches.get(waypoint), _name(waypoint)
        s_cv = similarity(match, self._profile) if match is not None else 0
        self._report(waypoint, s_cv, match)
        if self._has_arrived(match):
            return Event.REACHED, _hold(f"arrived at {name}, S {s_cv}", notes)
        if self.position.is_held and self._stands(match):
            self.position.stop()
            return None, _hold(f"at {name}, others go first", notes)
        if self._next_is_unclear(match, matches, observation.ranges):
            return Event.WAY_UNCLEAR, _hold(f"no free ground seen beyond {name}", notes)
        if self._has_waited_too_long(match):
            if blind := self._next_blind(observation.ranges, notes):
                return None, blind
            return Event.NO_PROGRESS, _hold(f"at {name}, {_name(self.position.next_waypoint)} unseen", notes)
        found = heading_of(match, self._profile) if match is not None else None
        if found is None and self._patience.waits:
            return None, _hold(f"at {name}, S {s_cv}", notes)
        if match is None or found is None or s_cv < self._profile.travel.s_via_min:
            return self._unseen(name, s_cv, observation.ranges, notes)
        self._patience.see()
        self._reckons = False
        self._heading_rad, method = self._steadied(waypoint, found[0], s_cv), found[1]
        if self._no_progress(match):
            if self._near_end(match):
                return Event.REACHED, _hold(f"as near to {name} as obstacles allow, S {s_cv}", notes)
            return Event.NO_PROGRESS, _hold(f"no progress towards {name}", notes)
        left_m = way_left_m(match, self._maps.graph)
        return None, self._towards(name, s_cv, method, left_m, observation, notes)

    def _towards(
        self,
        name: str,
        s_cv: int,
        method: str,
        left_m: float | None,
        observation: Observation,
        notes: tuple[Note, ...],
    ) -> Decision:
        """On to the present waypoint, slowly at the end of the path; past it where something stands there."""
        heading_rad, ranges = self._heading_rad or 0.0, observation.ranges
        skips = self._tried_before(self.position.index) and self.position.index < self.position.last
        taken = skips and is_taken(ranges, heading_rad, left_m, self._profile)
        if taken and (blind := self._next_blind(ranges, notes)):
            return blind
        slow = self.position.is_at_end and self._destination.arrival_rad > 0.0
        speed = speed_fraction(left_m - observation.since.way_m) if slow and left_m is not None else 1.0
        why = f"to {name}, S {s_cv}"
        return Decision("go", heading_rad, s_cv, speed, method, why, notes, distance_m=left_m)

    def _turn(self, observation: Observation) -> None:
        """Directions are kept in the robot's frame, which turned."""
        self._patience.begin_frame(observation.frame_share)
        self._steady.turned(observation.moved.turn_rad)
        if self._heading_rad is not None:
            self._heading_rad = observation.moved.direction(self._heading_rad)

    def way(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Nodes between which the robot is, and those of its way beyond: `PathPosition.way`."""
        return self.position.way(self._maps.graph, self._tracker.here, self._like_goal())

    def _like_goal(self) -> int:
        """The node most like the goal picture, of one place alone; else the last one of the path."""
        last = self.position.path[-2:][0]
        like = self._destination.targets() if self.position.path[-1] == GOAL else {}
        if like and (last == GOAL or not self._destination.aliased):
            return min(like, key=lambda node: (like[node], node))
        return last

    def may_go(self, free: int) -> None:
        """Of the way beyond so many nodes may be driven to, in the frame to come."""
        self.position.may_go(free, self._tracker.here)

    def failed_edge(self) -> tuple[EdgeKey | None, int]:
        """What stopped the robot: the edge driven and its waypoint; at a waypoint, what comes next."""
        if self._patience.has_waited_too_long:
            return self.position.next_edge, self.position.next_waypoint
        return self.position.edge, self.position.waypoint

    def _tried_before(self, index: int) -> bool:
        """Whether the edge to a waypoint, or the one before it, was driven in vain; not by the thesis."""
        way = self.position.path[max(0, index - 2) : index + 1]
        return not self._strict and was_driven_in_vain(self._maps.graph, way)

    def _has_arrived(self, match: NodeMatch | None) -> bool:
        if match is None or not self.position.is_at_end or self._ahead.is_beyond(self.position.waypoint):
            return False
        return has_arrived(match, self._maps.graph, self._profile, self._destination.arrival_rad)

    def _next_is_unclear(self, here: NodeMatch | None, seen: Matches, ranges: Ranges) -> bool:
        """At a waypoint with no sight of free ground to the next: ask for another way, once."""
        if not self._stands(here):
            return False
        position = self.position
        return not self._ahead.is_known(position.next_edge, seen.get(position.next_waypoint), ranges)

    def _stands(self, here: NodeMatch | None) -> bool:
        """Whether the robot stands at a waypoint from which it has to go on; the thesis does not ask."""
        goes_on = not (self._strict or self.position.is_at_end)
        return goes_on and self._ahead.is_at(self.position.waypoint, here)

    def _advance(self, matches: Matches, ranges: Ranges) -> tuple[Note, ...]:
        """Go on to the latest waypoint that may be headed for; by the thesis only to the next."""
        at = self.position
        later = self._ahead.furthest(at.path[: at.last + 1], at.index, matches, ranges)
        if later == at.index:
            return ()
        here, via = matches.get(at.waypoint), at.path[later]
        learnt = self._mark_driven(here)
        self._head_for(later)
        s_here = similarity(here, self._profile) if here is not None else 0
        values = {"s_cv": s_here, "s_nv": similarity(matches[via], self._profile), "via": via}
        return (*learnt, Note("via_advanced", f"next waypoint {_name(via)}", dict(values)))

    def _head_for(self, index: int) -> None:
        """Make another waypoint the present one, of which no progress is known yet."""
        self.position.index = index
        self._patience.aim_anew()

    def _mark_driven(self, match: NodeMatch | None) -> tuple[Note, ...]:
        """The robot stands at a waypoint: the edge to it has been driven."""
        edge = self.position.edge
        if edge is None or GOAL in edge or not self._ahead.is_at(self.position.waypoint, match):
            return ()
        note = self._experience.driven(edge, match)
        return () if note is None else (note,)

    def _steadied(self, waypoint: int, seen_rad: float, s_cv: int) -> float:
        if self._strict:
            return seen_rad
        return self._steady.follow(waypoint, seen_rad, close=s_cv >= self._profile.mapping.s_node_max)

    def _unseen(
        self, name: str, s_cv: int, ranges: Ranges, notes: tuple[Note, ...]
    ) -> tuple[Event | None, Decision]:
        """The waypoint is not seen: on for a few frames, then by the map; a goal by the map at once."""
        at_goal = self.position.waypoint == GOAL
        if at_goal and (blind := self._blind(ranges, notes, self.position.index)):
            return None, blind
        self._patience.miss()
        unseen_frames = self._patience.unseen_frames
        if unseen_frames < self._profile.travel.suspend_after and self._heading_rad is not None:
            why = f"{name} not seen for {unseen_frames:.0f} frames, keeping on"
            return None, Decision("go", self._heading_rad, s_cv, 1.0, "previous", why, notes)
        blind = None if at_goal else self._blind(ranges, notes, self.position.index)
        return (None, blind) if blind else (Event.WAYPOINT_LOST, _hold(f"{name} not seen, S {s_cv}", notes))

    def _next_blind(self, ranges: Ranges, notes: tuple[Note, ...]) -> Decision | None:
        """On to the next waypoint, which does not show from this one; None where that has to be given up."""
        blind = self._blind(ranges, notes, self.position.index + 1)
        if blind is not None:
            self._patience.stand(False)
        return blind

    def _blind(self, ranges: Ranges, notes: tuple[Note, ...], first: int) -> Decision | None:
        """To where the map has that waypoint, and past it to the next one; only for some frames of a path.

        Not where what stands on the nearer half of the way shuts it, while there is another; who is on such a
        way goes round. A picture that is near has to show.
        """
        at = self.position
        if self._strict or len(at.path) < 2 or self._destination.picture is None:
            return None
        if not self._patience.goes_on_blind():
            return None
        ahead = range(first, at.last + 1)
        picture = self._destination.lies(at.path[-2]) if at.path[-1] == GOAL else None
        spot = next_reckoned(self._maps.graph, self._tracker.here, at.path, ahead, picture)
        if spot is None:
            return None
        index, heading_rad, left_m = spot
        goes_round = self._reckons or self._experience.tried_again or self._tried_before(first)
        shut = is_shut(ranges, heading_rad, left_m, self._profile)
        if shut and at.path[index] != GOAL and not goes_round:
            return None
        self._reckons = True
        if index != at.index:
            self._head_for(index)
        self._heading_rad = heading_rad
        why = f"{_name(at.path[index])} not seen: to where the map has it"
        return Decision("go", heading_rad, 0, 1.0, "reckoned", why, notes, distance_m=left_m)

    def _no_progress(self, match: NodeMatch) -> bool:
        disparity = match.disparity_rad if match.disparity_rad is not None else 0.0
        s_cv = similarity(match, self._profile)
        return self._patience.makes_no_progress(disparity, s_cv, self._near_end(match))

    def _has_waited_too_long(self, match: NodeMatch | None) -> bool:
        """At a waypoint from which the next one does not show: what leads there is shut."""
        self._patience.stand(self._stands(match))
        return self._patience.has_waited_too_long

    def _near_end(self, match: NodeMatch) -> bool:
        return self.position.is_at_end and is_near_end(
            match, self._maps.graph, self._profile, self._destination.arrival_rad
        )

    def _report(self, waypoint: int, s_cv: int, match: NodeMatch | None) -> None:
        disparity = match.disparity_rad if match is not None else None
        nearest = waypoint if waypoint != GOAL else None
        self.progress = Progress(tuple(self.position.path), self.position.index, nearest, s_cv, disparity)


def _hold(why: str, notes: tuple[Note, ...]) -> Decision:
    return Decision("hold", why=why, notes=notes)


def _name(node_id: int) -> str:
    return "the goal" if node_id == GOAL else f"node {node_id}"
