"""Looking ahead along a path: what is compared, and how far along it the robot may head."""

from collections.abc import Collection, Sequence

from services.planner.ports import MapAccess, Matcher, Matches
from services.planner.profiles import Profile
from services.planner.surroundings import is_half_clear
from services.planner.travel.destination import Destination
from services.planner.travel.following.waypoints import is_at, is_strict, may_advance
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import EdgeKey, edge_key
from shared.mapgraph.local.keep_clear import clear_nodes, is_near_forbidden
from shared.mapgraph.routing import GOAL
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

WINDOW = 4
"""Waypoints compared at each step; chosen: nodes lie 0.7 m apart and are recognised up to some 2.5 m away."""

BESIDE = 3
"""Nodes around the robot that are compared beside those ahead; chosen: they alone tell a corridor whose doors
repeat from itself one door further, for those ahead look the same there."""


class Lookahead:
    """Says of waypoints ahead what is seen of them. `unclear` are edges that were doubted already."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        destination: Destination,
        unclear: Collection[EdgeKey],
        tracker: Tracker,
    ) -> None:
        self._profile, self._maps, self._destination = profile, maps, destination
        self._unclear, self._tracker = unclear, tracker
        self._strict = is_strict(profile)

    def compare(self, waypoints: Sequence[int], matcher: Matcher) -> dict[int, NodeMatch]:
        """Compare the frame with the first waypoints, nodes around the robot, and the goal."""
        ahead = [node for node in dict.fromkeys(waypoints[:WINDOW]) if node != GOAL]
        picture = self._destination.picture
        around = [*self._tracker.nearby()[:BESIDE], *self._tracker.elsewhere]
        nodes = list(dict.fromkeys([*ahead, *around]))
        of_map = self._tracker.compared
        seen = matcher.match(nodes, of_map, () if picture is None else (picture,))
        goal = {GOAL: seen.pop(GOAL)} if GOAL in seen else {}
        possible = self._tracker.possible(seen, of_map=of_map > 0)
        self._tracker.confirm(possible)
        if goal and not self._destination.sees(goal[GOAL], self._tracker.here):
            goal = {}
        return {**possible, **goal}

    def is_at(self, waypoint: int, match: NodeMatch | None) -> bool:
        """Whether the robot stands at a waypoint.

        Another light takes half of the matches, and in the open a small disparity means near only where many
        agree. Who came to a node by all that it saw and did, and sees no baseline to it, is there.
        """
        if match is None:
            return False
        is_there = is_at(match, self._maps.graph, self._profile)
        is_there = is_there or (not self._strict and self._tracker.came_to(waypoint, match))
        return is_there and not self.is_beyond(waypoint)

    def is_beyond(self, waypoint: int) -> bool:
        """Whether what the robot did says that it is not at a waypoint; the thesis does not ask."""
        return not self._strict and self._tracker.is_beyond(waypoint)

    def furthest(self, path: Sequence[int], index: int, matches: Matches, ranges: Ranges) -> int:
        """Index of the latest waypoint that may be headed for, by the thesis the next; else `index`."""
        reach = WINDOW - 1 if self._destination.cuts_corners and not self._strict else 1
        for later in range(min(index + reach, len(path) - 1), index, -1):
            there = matches.get(path[later])
            if there is not None and self._may_advance(path, index, later, matches, ranges):
                return later
        return index

    def is_known(self, edge: EdgeKey, there: NodeMatch | None, ranges: Ranges) -> bool:
        """Driven before, seen free before and not shut now, or no other way was left when it was unclear."""
        known = self._maps.graph.edge(*edge)
        if edge in self._unclear or (known is not None and known.traversals > 0):
            return True
        if known is None or not known.clear or there is None:
            return False
        return is_half_clear(there, self._maps.graph, ranges, self._profile)

    def _may_advance(
        self, path: Sequence[int], index: int, later: int, matches: Matches, ranges: Ranges
    ) -> bool:
        here, there = matches.get(path[index]), matches[path[later]]
        beside = later == index + 1 and self.is_at(path[index], here)
        if not beside and (not self._destination.cuts_corners or self._crosses_keep_out(path[later])):
            return False
        aliased_goal = self._destination.aliased and path[later] == GOAL
        return may_advance(
            here,
            there,
            self._maps.graph,
            ranges,
            self._profile,
            straight=beside or not aliased_goal,
            beside=beside and self.is_known(edge_key(path[index], path[later]), there, ranges),
        )

    def _crosses_keep_out(self, waypoint: int) -> bool:
        """Whether the short way to a later waypoint leads where the path goes round."""
        forbidden, here, graph = self._maps.limits().forbidden, self._tracker.here, self._maps.graph
        if not forbidden:
            return False
        if waypoint == GOAL or here is None:  # where they are is not sure enough to cut a corner
            return is_near_forbidden(graph, here, forbidden)
        return waypoint not in clear_nodes(graph, here, [waypoint], forbidden)
