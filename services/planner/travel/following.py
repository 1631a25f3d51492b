"""Following a path of places: which via point to aim at, when to go on to the next, when to give up."""

from dataclasses import dataclass
from typing import Literal

from services.planner.mapping.surroundings import is_clear
from services.planner.ports import GOAL, Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import apart_rad, close_enough, heading_of, similarity, trusted
from services.planner.travel.experience import Experience, Leg, leg
from services.planner.travel.steadiness import SteadyHeading
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

WINDOW = 4
"""Via points compared at each step: the current one and those after it."""

STUCK_STEPS = 35
CLOSER = 0.95
WAITING_STEPS = 8
"""Steps at a via point after which the next one should have shown."""

SLOW_M = 1.33
SLOWEST = 0.15
NEAREST_STEPS = 8
"""Steps without coming closer after which a place within `near_rad` is as near as obstacles allow."""

FollowState = Literal["going", "arrived", "lost", "stuck", "unclear"]


@dataclass
class Target:
    """End of the path: a goal picture, or the last node when `features` is None.

    Attributes:
        look_alike: the goal picture resembles a wrong place too: it counts only from the last via point on.
    """

    features: Features | None
    arrival_rad: float
    look_alike: bool = False


class PathFollower:
    """Drives along `path` (node ids; GOAL may be last) with equation 4.3 and looks ahead along it."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        path: list[int],
        target: Target,
        doubted: set[Leg],
        experience: Experience,
    ) -> None:
        self._profile, self._maps, self._target = profile, maps, target
        self._strict = profile.path_cost == "nodes"
        self._doubted, self._experience = doubted, experience
        self.path = path
        self.index = 0
        self._bad = 0
        self._heading_rad: float | None = None
        self._steady = SteadyHeading()
        self._best_rad = float("inf")
        self._stale = self._waiting = 0
        self.progress = Progress(via_points=tuple(path))

    def step(self, observation: Observation, matcher: Matcher) -> tuple[FollowState, Decision]:
        """Compare with the next via points, advance, and head for the current one."""
        matches = self._look(matcher)
        notes = self._advance(matches, observation.ranges)
        via = self.path[self.index]
        match = matches.get(via)
        s_cv = similarity(match, self._profile) if match is not None else 0
        self._report(via, s_cv, match)
        if self._at_end() and match is not None and self._arrived(match, s_cv):
            return "arrived", self._hold(f"arrived at {_name(via)}, S {s_cv}", notes)
        if self._unclear_leg(match) is not None:
            return "unclear", self._hold(f"no free ground seen beyond {_name(via)}", notes)
        found = heading_of(match, self._profile) if match is not None else None
        if match is None or found is None or s_cv < self._profile.s_via_min:
            return self._unseen(via, s_cv, notes)
        self._bad = 0
        seen_rad, method = found
        self._heading_rad = (
            seen_rad
            if self._strict
            else self._steady.follow(via, seen_rad, close=s_cv >= self._profile.s_node_max)
        )
        if self._waits_too_long(match):
            return "stuck", self._hold(f"at {_name(via)}, {_name(self.path[self.index + 1])} unseen", notes)
        if self._no_progress(match):
            if self._near_end(match):
                return "arrived", self._hold(f"as near to {_name(via)} as obstacles allow, S {s_cv}", notes)
            return "stuck", self._hold(f"no progress towards {_name(via)}", notes)
        why = f"to {_name(via)}, S {s_cv}"
        return "going", Decision("go", self._heading_rad, s_cv, self._speed(match), method, why, notes)

    def current_leg(self) -> Leg | None:
        """The leg being driven; None at index 0, where there is none (thesis equation 6.4)."""
        return leg(*self.path[self.index - 1 : self.index + 1]) if self.index else None

    def failed_leg(self) -> tuple[Leg | None, int]:
        """What stopped the robot: the leg being driven and its via point; at a via point, what comes next."""
        if self._waiting > WAITING_STEPS:
            return self.next_leg(), self.path[self.index + 1]
        return self.current_leg(), self.path[self.index]

    def next_leg(self) -> Leg:
        """The leg from the current via point to the one after it."""
        return leg(*self.path[self.index : self.index + 2])

    def _at_end(self) -> bool:
        return self.index == len(self.path) - 1

    def _unclear_leg(self, match: NodeMatch | None) -> Leg | None:
        """At a via point with no sight of free ground to the next: ask for another way, once."""
        if self._strict or self._at_end() or not self._is_at(match) or self._known_leg():
            return None
        return self.next_leg()

    def _is_at(self, match: NodeMatch | None) -> bool:
        if match is None or not close_enough(match, self._profile):
            return False
        near = match.disparity_rad is not None and match.disparity_rad < self._profile.travel_arrival_rad
        return match.status == "no_baseline" or near

    def _known_leg(self) -> bool:
        """Driven before, or there was no other way when it was doubted."""
        edge = self._maps.graph.edge(*self.next_leg())
        return self.next_leg() in self._doubted or (edge is not None and edge.traversals > 0)

    def _look(self, matcher: Matcher) -> dict[int, NodeMatch]:
        ahead = self.path[self.index : self.index + WINDOW]
        targets = (self._target.features,) if self._target.features is not None else ()
        return matcher.match([n for n in ahead if n != GOAL], targets=targets)

    def _advance(self, matches: dict[int, NodeMatch], ranges: Ranges) -> tuple[Note, ...]:
        """Equation 4.3; by default also straight to a later via point over ground that is seen free."""
        here = matches.get(self.path[self.index])
        s_here = similarity(here, self._profile) if here is not None else 0
        reach = 1 if self._strict else WINDOW - 1
        for later in range(min(self.index + reach, len(self.path) - 1), self.index, -1):
            there = matches.get(self.path[later])
            if there is None or not self._may_advance(here, there, later, ranges):
                continue
            s_there = similarity(there, self._profile)
            learnt = self._mark_driven(here)
            self.index, self._best_rad, self._stale = later, float("inf"), 0
            values = {"s_cv": s_here, "s_nv": s_there, "via": self.path[later]}
            return (*learnt, Note("via_advanced", f"next via {_name(self.path[later])}", dict(values)))
        return ()

    def _may_advance(self, here: NodeMatch | None, there: NodeMatch, later: int, ranges: Ranges) -> bool:
        s_here = similarity(here, self._profile) if here is not None else 0
        s_there = similarity(there, self._profile)
        if self._strict:
            return s_here > self._profile.s_via_max and s_there > self._profile.s_via_min
        beside = later == self.index + 1 and self._is_at(here)
        early = self._target.look_alike and self.path[later] == GOAL and not beside
        if not early and trusted(there, self._profile) and is_clear(there, ranges, self._profile):
            return s_there > self._profile.s_edge_min
        return beside and self._known_leg() and s_there > self._profile.s_via_min

    def _mark_driven(self, match: NodeMatch | None) -> tuple[Note, ...]:
        """The robot stands at a via point: the leg to it has been driven."""
        ends = self.current_leg()
        if ends is None or GOAL in ends or not self._is_at(match):
            return ()
        note = self._experience.driven(ends, match)
        return () if note is None else (note,)

    def _arrived(self, match: NodeMatch, s_cv: int) -> bool:
        if s_cv > self._profile.s_final:
            return True
        if self._target.arrival_rad <= 0.0 or match.inliers < self._profile.s_edge_min:
            return False
        if not close_enough(match, self._profile):
            return False
        near = match.disparity_rad is not None and match.disparity_rad < self._target.arrival_rad
        return match.status == "no_baseline" or (match.status == "ok" and near)

    def _speed(self, match: NodeMatch) -> float:
        """Slow down over the last metre or so, as disparity tells it, so as not to overshoot the goal."""
        if not self._at_end() or match.disparity_rad is None or self._target.arrival_rad <= 0.0:
            return 1.0
        left_rad = apart_rad(match.disparity_rad, match.inliers, self._profile)
        return min(1.0, max(SLOWEST, left_rad / (SLOW_M * self._profile.disparity_rad_per_m)))

    def _unseen(self, via: int, s_cv: int, notes: tuple[Note, ...]) -> tuple[FollowState, Decision]:
        """The via point is not seen: keep going for a few frames, then report lost."""
        self._bad += 1
        if self._bad >= self._profile.suspend_after or self._heading_rad is None:
            return "lost", self._hold(f"{_name(via)} not seen, S {s_cv}", notes)
        why = f"{_name(via)} not seen for {self._bad} frames, keeping on"
        return "going", Decision("go", self._heading_rad, s_cv, 1.0, "previous", why, notes)

    def _no_progress(self, match: NodeMatch) -> bool:
        disparity = match.disparity_rad if match.disparity_rad is not None else 0.0
        if disparity < self._best_rad * CLOSER:
            self._best_rad, self._stale = disparity, 0
        else:
            self._stale += 1
        return self._stale > (NEAREST_STEPS if self._near_end(match) else STUCK_STEPS)

    def _waits_too_long(self, match: NodeMatch) -> bool:
        """At a via point from which the next one does not show: what leads there is shut."""
        at_via = not (self._strict or self._at_end()) and self._is_at(match)
        self._waiting = self._waiting + 1 if at_via else 0
        return self._waiting > WAITING_STEPS

    def _near_end(self, match: NodeMatch) -> bool:
        near = match.disparity_rad is not None and match.disparity_rad < self._profile.near_rad
        near = near and similarity(match, self._profile) > self._profile.s_near
        return self._at_end() and near and self._target.arrival_rad > 0.0

    def _report(self, via: int, s_cv: int, match: NodeMatch | None) -> None:
        disparity = match.disparity_rad if match is not None else None
        self.progress = Progress(tuple(self.path), self.index, via if via != GOAL else None, s_cv, disparity)

    def _hold(self, why: str, notes: tuple[Note, ...]) -> Decision:
        return Decision("hold", why=why, notes=notes)


def _name(node_id: int) -> str:
    return "the goal" if node_id == GOAL else f"node {node_id}"
