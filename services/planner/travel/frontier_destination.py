"""The node to explore from next, as a destination; what cannot be reached is closed."""

from collections.abc import Mapping

from services.planner.mapping.frontiers.allowed_directions import AllowedDirections
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.frontiers.visiting_order import first_to_visit
from services.planner.ports import MapAccess, Matcher, Note
from services.planner.profiles import Profile
from services.planner.travel.destination import NodeDestination, Setback, Verdict
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.localisation import edge_cost
from services.planner.travel.tracking import Tracker
from shared.mapgraph.frontiers import frontier_sectors, without_frontiers
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import open_ways
from shared.messages.maps import UpdateNode
from shared.messages.missions import FailureKind

COMPARED = 5
"""Nodes compared to localise a frame; chosen: the robot has been at all of them, so the nearest few
suffice."""

FAILURES_MAX = 2
"""Travels in vain after which a node's directions are closed (decision 0004)."""

IN_VAIN_MAX = 4
"""Travels in vain, one after the other, after which their ends are blamed too; chosen: twice FAILURES_MAX."""

STRANDED_STEPS = 12
"""Steps of searching after which starts that failed are tried again; chosen: 1.4 m, round one piece of
furniture."""

SEARCH_STEPS = 120
"""Steps of searching before exploration ends as lost; chosen: the third growing sweep, 14 m at 0.12 m a
step."""

NEXT_M = 500.0
"""Other frontiers than the next one cost so much more; chosen: more than a way across a village, less than a
suspended edge, so that they are gone to only where no way leads to that one."""

UNJUDGED_GAIN = 0.3
"""New floor that a node leads to which this mission did not judge, as a share of a disc; chosen: a third."""


class FrontierDestination(NodeDestination):
    """Any node with a frontier; remembers what failed, so that exploration always ends.

    Attributes:
        reached: the node at which the last travel ended.
    """

    compared, search_steps = COMPARED, SEARCH_STEPS
    cuts_corners = True

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        experience: EdgeExperience,
        directions: AllowedDirections,
        views: FloorViews,
    ) -> None:
        super().__init__(matcher)
        self._profile, self._maps = profile, maps
        self._directions, self._set_aside = directions, set[int]()
        self._views = views
        self._chosen: int | None = None
        self._experience = experience
        self.arrival_rad = profile.arrival.travel_arrival_rad
        self.reached = 0
        self._end = 0
        self._failures: dict[int, int] = {}
        self._bad_starts: set[int] = set()
        self._in_vain = self._cut_off = self._stranded = 0

    def targets(self) -> dict[int, float]:
        """Nodes with a frontier that the rules let a robot leave by; NEXT_M more for others than the next."""
        nodes = [n for n, node in self._maps.graph.nodes.items() if frontier_sectors(node)]
        wanted = [n for n in nodes if n not in self._set_aside and self._directions.of(n)]
        chosen = self._chosen in wanted
        return {n: NEXT_M if chosen and n != self._chosen else 0.0 for n in wanted}

    def choose(self, here: Displacement | None) -> bool:
        """Choose the node to go to next; False where there is none.

        Args:
            here: where the robot is; None where nobody knows: the nearest is next.
        """
        self._chosen = None
        wanted = self.targets()
        if here is not None and len(wanted) > 1:
            graph, gains = self._maps.graph, self._views.gains
            cost, banned = edge_cost(graph, self._profile), self._experience.banned
            ways = open_ways(graph, cost, banned, self._maps.limits())
            worth = {n: gains.get(n, UNJUDGED_GAIN) for n in wanted}
            self._chosen = first_to_visit(ways, here.node_id, worth)
        return bool(wanted)

    def beyond(self, _end: int) -> tuple[int, ...]:
        """The path ends at the frontier."""
        return ()

    def starts(self, visible: Mapping[int, float]) -> Mapping[int, float]:
        """Those in sight that did not fail as a start; all again once the robot has moved on for a while."""
        starts = {n: cost for n, cost in visible.items() if n not in self._bad_starts}
        if visible and not starts:
            self._stranded += 1
            if self._stranded > STRANDED_STEPS:
                self._bad_starts, self._stranded = set(), 0
        return starts

    def set_out(self) -> None:
        """There is a path again."""
        self._cut_off = 0

    def no_path(self) -> Verdict:
        """After a few such frames what is left is closed."""
        frontier = self.targets()
        self._cut_off += 1
        why = f"no path to {len(frontier)} nodes with unexplored directions"
        if self._cut_off < self._profile.mapping.saturation_steps:
            return Verdict(why=why)
        nodes = self._maps.graph.nodes
        if self._maps.limits():  # a rule may be why, and another day it may not hold
            self._set_aside |= frontier.keys()
            return Verdict(notes=(Note("nodes_set_aside", f"{why} that the rules allow"),), why=why)
        self._maps.commit([UpdateNode(node=without_frontiers(nodes[n])) for n in frontier])
        values: dict[str, float | int | str | bool | None] = {"nodes": len(frontier)}
        return Verdict(notes=(Note("nodes_unreachable", f"{why}: closed", values),), why=why)

    def setback(self, setback: Setback) -> Verdict:
        """Twice in vain: that node's directions are closed.

        A way that ended early blames its end only when others ended before it; one that ended before its
        first waypoint says nothing of the end, and is tried from another node in sight.
        """
        end = setback.path[-1]
        self._in_vain += setback.edge is not None
        blamed = setback.waypoint == end or (setback.edge is not None and self._in_vain > IN_VAIN_MAX)
        self._failures[end] = self._failures.get(end, 0) + blamed
        notes = [Note("travel_failed", f"to node {end}: {setback.why}")]
        if setback.edge is None:
            self._bad_starts.add(setback.waypoint)
        else:
            notes.append(self._experience.failed(setback.edge, setback.why))
        if self._failures[end] >= FAILURES_MAX:
            self._maps.commit([UpdateNode(node=without_frontiers(self._maps.graph.nodes[end]))])
            notes.append(Note("node_unreachable", f"node {end}: its directions are closed"))
        return Verdict(tuple(notes))

    def unreachable(self) -> tuple[FailureKind, str]:
        """All is explored; the mission ends before it asks."""
        return "no_path", "nothing unexplored is left"

    def refutes_arrival(self, end: int, similarity: int, tracker: Tracker) -> str:
        """Whether the view belongs to another part of the map."""
        if refuted := super().refutes_arrival(end, similarity, tracker):
            return refuted
        self._bad_starts, self._in_vain = set(), 0
        self.reached = end
        return ""
