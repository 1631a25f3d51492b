"""Following a path of places: which via point to aim at, when to go on to the next, when to give up."""

from dataclasses import dataclass
from typing import Literal

from services.planner.ports import GOAL, Decision, MapAccess, Matcher, Note, Progress
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, similarity, trusted
from shared.messages.features import Features
from shared.messages.maps import PutEdge
from shared.messages.matching import NodeMatch

WINDOW = 4
"""Via points compared at each step: the current one and those after it."""

STUCK_STEPS = 45
BLIND_STEPS = 3
CLOSER = 0.93

FollowState = Literal["going", "arrived", "lost", "stuck"]


@dataclass
class Target:
    """End of the path: a goal picture, or the last node when `features` is None."""

    features: Features | None
    arrival_rad: float


class PathFollower:
    """Drives along `path` (node ids; GOAL may be last) with equation 4.3 and looks ahead along it."""

    def __init__(self, profile: Profile, maps: MapAccess, path: list[int], target: Target) -> None:
        self._profile, self._maps, self._target = profile, maps, target
        self.path = path
        self.index = 0
        self._bad = 0
        self._heading_rad: float | None = None
        self._best_rad = float("inf")
        self._stale = 0
        self.progress = Progress(via_points=tuple(path))

    def step(self, matcher: Matcher) -> tuple[FollowState, Decision]:
        """Compare with the next via points, advance, and head for the current one."""
        matches = self._look(matcher)
        notes = self._advance(matches)
        via = self.path[self.index]
        match = matches.get(via)
        s_cv = similarity(match, self._profile) if match is not None else 0
        self._report(via, s_cv, match)
        if self.index == len(self.path) - 1 and match is not None and self._arrived(match, s_cv):
            return "arrived", self._hold(f"arrived at {_name(via)}, S {s_cv}", notes)
        found = heading_of(match, self._profile) if match is not None else None
        if match is None or found is None or s_cv < self._profile.s_via_min:
            return self._unseen(via, s_cv, notes)
        self._bad = 0
        self._heading_rad, method = found
        if self._no_progress(match):
            return "stuck", self._hold(f"no progress towards {_name(via)}", notes)
        why = f"to {_name(via)}, S {s_cv}"
        return "going", Decision("go", self._heading_rad, s_cv, self._speed(match), method, why, notes)

    def current_edge(self) -> tuple[int, int] | None:
        """The edge being driven; None at index 0, where there is none (thesis equation 6.4)."""
        if self.index == 0 or GOAL in self.path[self.index - 1 : self.index + 1]:
            return None
        first, second = self.path[self.index - 1 : self.index + 1]
        return (min(first, second), max(first, second))

    def _look(self, matcher: Matcher) -> dict[int, NodeMatch]:
        ahead = self.path[self.index : self.index + WINDOW]
        targets = (self._target.features,) if self._target.features is not None else ()
        return matcher.match([n for n in ahead if n != GOAL], targets=targets)

    def _advance(self, matches: dict[int, NodeMatch]) -> tuple[Note, ...]:
        """Equation 4.3 for the next via point; with two-view geometry also straight to one well in sight."""
        notes = []
        strict = self._profile.path_cost == "nodes"
        for step in (1, 2, 3):
            later = self.index + step
            if later >= len(self.path) or (strict and step > 1):
                break
            here, there = matches.get(self.path[self.index]), matches.get(self.path[later])
            if there is None:
                continue
            s_here = similarity(here, self._profile) if here is not None else 0
            s_there = similarity(there, self._profile)
            near = s_here > self._profile.s_via_max and s_there > self._profile.s_via_min
            overtaken = (
                not strict
                and trusted(there, self._profile)
                and s_there > max(s_here, self._profile.s_edge_min)
            )
            reached = (
                not strict
                and here is not None
                and here.disparity_rad is not None
                and here.disparity_rad < self._target.arrival_rad * 3
                and s_there > self._profile.s_via_min
            )
            if near or overtaken or reached:
                values = {"s_cv": s_here, "s_nv": s_there, "via": self.path[later]}
                notes.append(Note("via_advanced", f"next via {_name(self.path[later])}", dict(values)))
                self._mark_driven(self.index, later)
                self.index, self._best_rad, self._stale = later, float("inf"), 0
                break
        return tuple(notes)

    def _mark_driven(self, start: int, end: int) -> None:
        """A via point passed: the edge was driven once more."""
        if end != start + 1 or GOAL in self.path[start : end + 1]:
            return
        edge = self._maps.graph.edge(self.path[start], self.path[end])
        if edge is not None and edge.traversals == 0:
            self._maps.commit([PutEdge(edge=edge.model_copy(update={"traversals": 1, "why": "driven"}))])

    def _arrived(self, match: NodeMatch, s_cv: int) -> bool:
        if s_cv > self._profile.s_final:
            return True
        if self._target.arrival_rad <= 0.0 or match.inliers < self._profile.s_edge_min:
            return False
        near = match.disparity_rad is not None and match.disparity_rad < self._target.arrival_rad
        return match.status == "no_baseline" or (match.status == "ok" and near)

    def _speed(self, match: NodeMatch) -> float:
        """Slow down over the last few degrees of disparity, so that a step does not overshoot the goal."""
        if self.index < len(self.path) - 1 or match.disparity_rad is None or self._target.arrival_rad <= 0.0:
            return 1.0
        return min(1.0, max(0.1, match.disparity_rad / (2.5 * self._target.arrival_rad)))

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
        return self._stale > STUCK_STEPS

    def _report(self, via: int, s_cv: int, match: NodeMatch | None) -> None:
        disparity = match.disparity_rad if match is not None else None
        self.progress = Progress(tuple(self.path), self.index, via if via != GOAL else None, s_cv, disparity)

    def _hold(self, why: str, notes: tuple[Note, ...]) -> Decision:
        return Decision("hold", why=why, notes=notes)


def _name(node_id: int) -> str:
    return "the goal" if node_id == GOAL else f"node {node_id}"
