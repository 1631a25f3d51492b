"""What went wrong on the way to a goal: which edge or waypoint is to blame, and when it is enough."""

from services.planner.ports import MapAccess, Matches, Note
from services.planner.profiles import Profile
from services.planner.similarity import ranked
from services.planner.travel.destination import Setback, Verdict
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.states import Event
from shared.mapgraph.graph import EdgeKey
from shared.mapgraph.routing import GOAL
from shared.messages.missions import FailureKind

LOST_MAX = 12
"""Times a mission may lose its waypoint; chosen: more than any round of `topnav hide-and-seek` needed."""

STUCK_MAX = 8
"""Times it may come no nearer to one; chosen alike."""

REFUTED_MAX = 16
"""Arrivals that may turn out to be none; chosen: two at each of as many places as are ever named."""

MISTAKEN_MAX = 4
"""Times a robot may find that it was elsewhere than it believed before setbacks count on; chosen."""

AVOID_M = 3.0
"""Added to the cost of starting at a waypoint that failed; chosen: another node as near comes first."""


class Setbacks:
    """Counts what goes wrong in one mission.

    Attributes:
        avoided: cost added to starting at a waypoint that failed, metres.
        strayed: the robot was lost on a straight way to the goal, and has found no path since.
    """

    def __init__(self, profile: Profile, maps: MapAccess, experience: EdgeExperience) -> None:
        self._profile, self._maps, self._experience = profile, maps, experience
        self.avoided: dict[int, float] = {}
        self.strayed = False
        self._lost = self._stuck = self._refuted = self._mistaken = 0
        self._suspect: tuple[EdgeKey, str] | None = None
        self._relocated: set[EdgeKey] = set()
        self._stayed_near = False

    @property
    def any_on_a_straight_way(self) -> bool:
        """Whether the robot got stuck, went to a look-alike or was lost where it saw the goal."""
        return bool(self._stuck or self._refuted or self.strayed)

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

    def count(self, setback: Setback) -> Verdict:
        """Blame the edge or the waypoint that failed, and say whether it was once too often."""
        edge, waypoint = setback.edge, setback.waypoint
        self.avoided[waypoint] = self.avoided.get(waypoint, 0.0) + AVOID_M
        edge = edge if edge is None or GOAL not in edge else None
        notes: tuple[Note, ...] = (Note("replan", f"{setback.event.value}: {setback.why}"),)
        if setback.event is Event.WAYPOINT_LOST:
            self.strayed = setback.path == (GOAL,)
            if edge is not None:
                self._suspect = (edge, "lost")
            self._lost += 1
            given_up: FailureKind = "blocked" if self._experience.banned or self._stayed_near else "lost"
            return Verdict(notes, given_up if self._lost > LOST_MAX else "")
        if setback.event is Event.ALIASED:
            self._refuted += 1
            return Verdict(notes, "blocked" if self._refuted > REFUTED_MAX else "")
        self._stuck += 1
        notes += self._experience.stuck(edge, waypoint)
        return Verdict(notes, "blocked" if self._stuck > STUCK_MAX else "")

    def begin_anew(self) -> None:
        """The mission leads elsewhere now: what failed on the way to a place given up does not count."""
        self._lost = self._stuck = 0
        self._stayed_near = False

    def mistaken(self) -> None:
        """The robot was elsewhere than it believed: what failed were other edges and waypoints."""
        self._mistaken += 1
        if self._mistaken <= MISTAKEN_MAX:
            self.begin_anew()
            self.avoided.clear()
            self._suspect = None
            self._experience.forget()

    def judge_suspect(self, seen: Matches) -> tuple[Note, ...]:
        """A robot that finds itself far from the edge it lost was carried: that says nothing about the edge.

        One that is near it is not lost, as its mission may say in the end: what leads on is shut.
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
        self._stayed_near = True
        return (self._experience.failed(edge, why),)
