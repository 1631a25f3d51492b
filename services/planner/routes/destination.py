"""A route as a destination: its nodes one after the other, round what is blocked."""

from collections.abc import Mapping

from services.planner.ports import MapAccess, Matcher, Note, Progress
from services.planner.profiles import Profile
from services.planner.travel.destination import NodeDestination, Setback, Verdict
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.states import Event
from shared.mapgraph.graph import edge_key
from shared.messages.missions import FailureKind

COMPARED = 8
"""Nodes compared to localise a frame; as many as a goto compares."""

SEARCH_STEPS = 150
"""Steps of searching before the mission ends as lost; as of a goto."""

FAILURES_MAX = 2
"""Tries in vain after which a node is left out; chosen: one straight, one round."""

NO_PATH_FRAMES = 8
"""Frames without a path to a node after which it is left out; chosen: 2.4 s, in which a person has passed."""

AVOID_M = 3.0
"""Added to the cost of starting at a waypoint that failed; chosen: another node as near comes first."""


class RouteDestination(NodeDestination):
    """The end of a route, and the nodes before it.

    Attributes:
        at: index of the node to reach next.
        left_out: nodes that were not reached, in order.
    """

    compared, search_steps = COMPARED, SEARCH_STEPS
    cuts_corners = False

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        experience: EdgeExperience,
        nodes: tuple[int, ...],
        at: int = 0,
    ) -> None:
        super().__init__(matcher)
        self._maps, self._experience = maps, experience
        self.nodes, self.at = nodes, at
        self.arrival_rad = profile.arrival.arrival_rad
        self.left_out: list[int] = []
        self._end = at
        self._failures: dict[int, int] = {}
        self._avoid: dict[int, float] = {}
        self._no_path_frames = 0

    def targets(self) -> dict[int, float]:
        """The next node; none once the last one is left out."""
        return {self.nodes[self.at]: 0.0} if self.at < len(self.nodes) else {}

    def beyond(self, end: int) -> tuple[int, ...]:  # noqa: ARG002
        """The rest of the route, as far as its edges are there and nothing is known against them."""
        rest = self.nodes[self.at : self.at + 1]
        for node in self.nodes[self.at + 1 :]:
            if not self._is_open(rest[-1], node):
                break
            rest = (*rest, node)
        self._end = self.at + len(rest) - 1
        return rest[1:]

    def follow(self, path: Progress) -> None:
        """Which node of the route is next, by how much of the path is left."""
        left = len(path.via_points) - 1 - path.via_index
        self.at = max(self.at, self._end - left)

    def arrived(self) -> Note | None:
        """The robot is at the end of its path; a note where the route does not lead on from there."""
        here, self.at = self.nodes[self._end], self._end + 1
        if self.at >= len(self.nodes):
            return None
        there = self.nodes[self.at]
        why = f"edge {edge_key(here, there)} of the route is shut: by another way to node {there}"
        return Note("goes_round", why, {"node": there})

    def begin_again(self) -> None:
        """Another round: what failed in the last one may be open now."""
        self.at = self._end = 0
        self._failures.clear()
        self._avoid.clear()

    def starts(self, visible: Mapping[int, float]) -> dict[int, float]:
        """Without nodes that no way was found to; those that failed come later."""
        closed = self._experience.unreachable
        return {node: c + self._avoid.get(node, 0.0) for node, c in visible.items() if node not in closed}

    def set_out(self) -> None:
        """There is a path."""
        self._no_path_frames = 0

    def no_path(self) -> Verdict:
        """After a few such frames the node is left out."""
        why = f"no path to node {self.nodes[self.at]} of the route"
        self._no_path_frames += 1
        if self._no_path_frames < NO_PATH_FRAMES:
            return Verdict(why=why)
        self._no_path_frames = 0
        return self._leave_out(why, ())

    def setback(self, setback: Setback) -> Verdict:
        """Blame what failed, and go round; after two tries the node is left out."""
        node, edge, waypoint = self.nodes[self.at], setback.edge, setback.waypoint
        self._avoid[waypoint] = self._avoid.get(waypoint, 0.0) + AVOID_M
        notes: tuple[Note, ...] = (Note("replan", f"{setback.event.value}: {setback.why}"),)
        if setback.event is not Event.WAYPOINT_LOST:
            notes += self._experience.stuck(edge, waypoint)
        elif edge is not None:
            notes += (self._experience.failed(edge, "lost"),)
        self._failures[self.at] = self._failures.get(self.at, 0) + 1
        if self._failures[self.at] >= FAILURES_MAX:
            return self._leave_out(f"not reached: {setback.why}", notes)
        what = "the way" if edge is None else f"edge {edge}"
        why = f"{what} of the route is blocked, {setback.why}: by another way to node {node}"
        return Verdict((*notes, Note("goes_round", why, {"node": node})))

    def unreachable(self) -> tuple[FailureKind, str]:
        """The end of the route was left out."""
        return "blocked", f"node {self.nodes[-1]}, the end of the route, is not reached"

    def _leave_out(self, why: str, notes: tuple[Note, ...]) -> Verdict:
        node = self.nodes[self.at]
        self.left_out.append(node)
        self.at += 1
        note = Note("left_out", f"node {node} of the route is left out: {why}", {"node": node})
        failure = self.unreachable()[0] if self.at >= len(self.nodes) else ""
        return Verdict((*notes, note), failure, why)

    def _is_open(self, here: int, there: int) -> bool:
        """Whether an edge leads on that is believed and not found blocked."""
        edge, key = self._maps.graph.edge(here, there), edge_key(here, there)
        return edge is not None and not edge.suspended and key not in self._experience.banned
