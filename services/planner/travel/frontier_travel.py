"""Travel to the nearest place with something unexplored; what cannot be reached is closed."""

from dataclasses import dataclass, replace

from services.planner.frontiers import frontier_sectors
from services.planner.mapping.surroundings import is_clear
from services.planner.ports import Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import ranked
from services.planner.travel.experience import Experience, Leg
from services.planner.travel.following import PathFollower, Target
from services.planner.travel.region import places_around
from services.planner.travel.routing import plan_path, visible
from services.planner.travel.search import Search, search_back
from shared.messages.maps import Node, UpdateNode
from shared.messages.matching import NodeMatch

NEAR_NODES = 5
MAX_TRAVEL_FAILURES = 2
TRAVELS_IN_VAIN = 4
SEARCH_STEPS = 120


@dataclass(frozen=True)
class Arrival:
    """The robot stands at a place with unexplored directions, its camera turned by `yaw_rad`."""

    node_id: int
    yaw_rad: float
    notes: tuple[Note, ...]


class FrontierTravel:
    """Chooses a place, drives there, and remembers what failed."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._experience = Experience(profile, maps)
        self._doubted: set[Leg] = set()
        self._follower: PathFollower | None = None
        self._search: Search | None = None
        self._failures: dict[int, int] = {}
        self._bad_starts: set[int] = set()
        self._in_vain = 0
        self._cut_off = 0
        self._last: int | None = None
        self.progress: Progress | None = None

    def stand_at(self, node_id: int) -> None:
        """The robot knows where it is: it leaves from here."""
        self._search, self._last = None, node_id

    def step(self, observation: Observation, last_heading_rad: float) -> Decision | Arrival:
        """One step; `last_heading_rad` is where a lost robot came from, turned round."""
        self.progress = None
        if self._follower is not None:
            return self._go_on(observation, self._follower)
        return self._choose(observation, last_heading_rad)

    def _choose(self, observation: Observation, last_heading_rad: float) -> Decision | Arrival:
        """Nearest node with something unexplored; none left: the map is complete."""
        graph = self._maps.graph
        frontier = {n: 0.0 for n, node in graph.nodes.items() if frontier_sectors(node)}
        if not frontier:
            why = f"nothing unexplored is left: {len(graph.nodes)} places, {len(graph.edges)} edges"
            return Decision("hold", why=why, outcome="succeeded")
        matches = self._matcher.match([], NEAR_NODES)
        clear = {n for n, m in matches.items() if is_clear(m, observation.ranges, self._profile)}
        here = {n: matches[n] for n in places_around(graph, matches, self._profile, self._last)}
        starts = visible(here, self._profile, self._profile.s_via_min, clear)
        fresh = {n: cost for n, cost in starts.items() if n not in self._bad_starts} or starts
        path = plan_path(graph, fresh, frontier, self._profile, self._doubted, self._experience.banned)
        if not path:
            return self._no_way(frontier) if starts else self._look_for_map(matches, last_heading_rad)
        self._search, self._cut_off = None, 0
        target = Target(None, self._profile.travel_arrival_rad)
        self._follower = PathFollower(
            self._profile, self._maps, path, target, self._doubted, self._experience
        )
        return self._go_on(observation, self._follower)

    def _go_on(self, observation: Observation, follower: PathFollower) -> Decision | Arrival:
        state, decision = follower.step(observation, self._matcher)
        self.progress = follower.progress
        if state == "going":
            self._last = follower.path[follower.index]
            return decision
        self._follower = None
        if state == "arrived":
            return self._arrived(follower, decision)
        if state == "unclear":
            self._doubted.add(follower.next_leg())
            return Decision("hold", why=f"planning again: {decision.why}", notes=decision.notes)
        return self._failed(follower, decision)

    def _arrived(self, follower: PathFollower, decision: Decision) -> Decision | Arrival:
        end = follower.path[-1]
        matches = self._matcher.match([end], NEAR_NODES)
        if end not in places_around(self._maps.graph, matches, self._profile, self._last):
            why = f"a look-alike of node {end}: other places resemble this view more"
            return self._failed(follower, replace(decision, why=why))
        self._bad_starts, self._in_vain = set(), 0
        match = matches.get(end)
        yaw_rad = match.yaw_rad if match is not None and match.yaw_rad is not None else 0.0
        return Arrival(end, yaw_rad, decision.notes)

    def _failed(self, follower: PathFollower, decision: Decision) -> Decision:
        """Twice in vain: that place's directions are closed, so that exploration always ends.

        A way that ended early blames its end only when others ended before it; one that ended before its
        first place is tried from another place in sight.
        """
        end, (failed_leg, via) = follower.path[-1], follower.failed_leg()
        self._in_vain += 1
        if self._in_vain > 1:
            self._last = None
        blamed = via == end or self._in_vain > TRAVELS_IN_VAIN
        self._failures[end] = self._failures.get(end, 0) + blamed
        notes = (*decision.notes, Note("travel_failed", f"to node {end}: {decision.why}"))
        if failed_leg is None:
            self._bad_starts.add(via)
        else:
            notes += (self._experience.failed(failed_leg, decision.why),)
        if self._failures[end] >= MAX_TRAVEL_FAILURES:
            self._maps.commit([UpdateNode(node=_closed(self._maps.graph.nodes[end]))])
            notes += (Note("node_unreachable", f"node {end}: its directions are closed"),)
        return Decision("hold", why=decision.why, notes=notes)

    def _no_way(self, frontier: dict[int, float]) -> Decision:
        """Known places are seen, but no path leads on: after a few such frames what is left is closed."""
        self._cut_off += 1
        why = f"no path to {len(frontier)} places with unexplored directions"
        if self._cut_off < self._profile.saturation_steps:
            return Decision("hold", why=why)
        nodes = self._maps.graph.nodes
        self._maps.commit([UpdateNode(node=_closed(nodes[n])) for n in frontier])
        values: dict[str, float | int | str | bool | None] = {"nodes": len(frontier)}
        return Decision("hold", why=why, notes=(Note("nodes_unreachable", f"{why}: closed", values),))

    def _look_for_map(self, matches: dict[int, NodeMatch], last_heading_rad: float) -> Decision:
        """Lost mode (thesis section 4.2): towards the most similar place, else in growing sweeps."""
        if self._search is None:
            self._search = search_back(last_heading_rad, SEARCH_STEPS)
        if self._search.exhausted:
            why = f"no known place found again in {SEARCH_STEPS} steps"
            return Decision("hold", why=why, outcome="failed", failure="lost")
        heading_rad = self._search.next_heading()
        best = ranked(matches, self._profile)[:1]
        if best and best[0][1].heading_rad is not None:
            why = f"lost mode: towards node {best[0][0]}"
            return Decision("go", best[0][1].heading_rad, 0, 1.0, "search", why)
        return Decision("go", heading_rad, 0, 1.0, "search", "lost mode: back, then in growing sweeps")


def _closed(node: Node) -> Node:
    return node.model_copy(update={"explored": (True,) * len(node.explored)})
