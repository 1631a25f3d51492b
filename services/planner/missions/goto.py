"""Mission goto: drive to where a picture was taken (thesis sections 4.1 and 4.3)."""

from dataclasses import replace

from services.planner.mapping.surroundings import is_clear, is_clear_from
from services.planner.ports import GOAL, Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, trusted
from services.planner.travel.experience import Experience, Leg, leg
from services.planner.travel.following import PathFollower, Target
from services.planner.travel.region import places_around
from services.planner.travel.routing import plan_path, visible
from services.planner.travel.search import Search, search_back
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges

LOCALISE_K = 8
MAX_LOST = 12
MAX_STUCK = 8
SEARCH_STEPS = 150
LAST_LEG_RAD = 1.0
GOAL_SHARE = 0.6
"""Least similarity of an arrival relative to that of the most similar place: where the goal picture was
taken, nothing resembles the view more than the goal does. Of 75 arrivals in three worlds the right ones had
S 159 and more, the one look-alike 31."""


class Goto:
    """Localise current and target frame, plan, follow, replan; ends with arrival or a typed failure."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, goal: Features) -> None:
        self._profile, self._maps, self._matcher, self._goal = profile, maps, matcher, goal
        self._targets: dict[int, float] | None = None
        self._follower: PathFollower | None = None
        self._lost = self._stuck = 0
        self._look_alike = False
        self._avoid: dict[int, float] = {}
        self._doubted: set[Leg] = set()
        self._experience = Experience(profile, maps)
        self._suspect: tuple[Leg, str] | None = None
        self._excused: set[Leg] = set()
        self._search: Search | None = None
        self._last_heading_rad = 0.0
        self._last: int | None = None
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One step; the frame itself is already with the matcher."""
        notes: tuple[Note, ...] = ()
        if self._targets is None:
            self._targets = self._locate_goal()
            notes = (Note("goal_located", f"goal resembles nodes {sorted(self._targets)}"),)
        if self._follower is None:
            notes += self._plan_notes(here := self._localise(), observation.ranges)
            waiting = self._plan(here, observation.ranges)
            if waiting is not None:
                return _with_notes(waiting, notes)
        assert self._follower is not None
        state, decision = self._follower.step(observation, self._matcher)
        self.progress = self._follower.progress
        if state == "arrived":
            here = self._places_here()
            s_map = max((similarity(match, self._profile) for match in here.values()), default=0)
            if self._follower.progress.similarity >= GOAL_SHARE * s_map:
                return self._end("succeeded", "", decision.why, notes + decision.notes)
            self._deceived(here)
            why = f"a look-alike of the goal: a place of the map resembles this view more, S {s_map}"
            state, decision = "stuck", replace(decision, why=f"{decision.why}, {why}")
        if state == "going":
            self._last_heading_rad = decision.heading_rad
            if self.progress.nearest_node is not None:
                self._last = self.progress.nearest_node
            return _with_notes(decision, notes)
        return self._recover(state, decision, notes)

    def _localise(self) -> dict[int, NodeMatch]:
        """The goal and the most similar places of the whole map, from the current frame alone."""
        return self._matcher.match([], LOCALISE_K, (self._goal,))

    def _places_here(self) -> dict[int, NodeMatch]:
        """The places that resemble this view; none by the thesis's rules, which do not ask."""
        if self._profile.path_cost == "nodes":
            return {}
        return {node: match for node, match in self._localise().items() if node != GOAL}

    def _deceived(self, here: dict[int, NodeMatch]) -> None:
        """This is not where the picture was taken: nor is that beside the places seen from here."""
        self._look_alike = True
        seen = {node for node, match in here.items() if trusted(match, self._profile)}
        elsewhere = {node: cost for node, cost in (self._targets or {}).items() if node not in seen}
        self._targets = elsewhere or self._targets

    def _plan_notes(self, here: dict[int, NodeMatch], ranges: Ranges) -> tuple[Note, ...]:
        """What localisation says about edges: one that just failed, suspended ones that are seen free."""
        seen = {n: m for n, m in here.items() if n != GOAL and trusted(m, self._profile)}
        notes = list(self._judge_suspect(seen))
        for near in (n for n, m in seen.items() if m.status == "no_baseline"):
            for far, match in seen.items():
                if far != near and is_clear(match, ranges, self._profile):
                    note = self._experience.seen_free(leg(near, far), match)
                    notes += [] if note is None else [note]
        return tuple(notes)

    def _judge_suspect(self, seen: dict[int, NodeMatch]) -> tuple[Note, ...]:
        """A robot that finds itself far from the leg it lost was carried: that says nothing about the leg.

        Nobody carries it off the same leg twice: then the leg leads elsewhere than the map says.
        """
        if self._suspect is None or not seen:
            return ()
        (ends, why), self._suspect = self._suspect, None
        graph = self._maps.graph
        near = {*ends, *graph.neighbours(ends[0]), *graph.neighbours(ends[1])}
        best = ranked(seen, self._profile)[0][0]
        if best not in near and ends not in self._excused:
            self._excused.add(ends)
            return (Note("relocated", f"lost near edge {ends}, found again at node {best}"),)
        return (self._experience.failed(ends, why),)

    def _plan(self, here: dict[int, NodeMatch], ranges: Ranges) -> Decision | None:
        """Set a follower, or return how the mission goes on without one."""
        assert self._targets is not None
        here = dict(here)
        seen_goal = here.pop(GOAL, None)
        if seen_goal is not None and not self._stuck and self._in_sight(seen_goal, ranges):
            self._follow([GOAL])
            return None
        if not self._targets:
            return self._end("failed", "goal_not_in_map", "the goal resembles no place of the map", ())
        here = {n: here[n] for n in places_around(self._maps.graph, here, self._profile, self._last)}
        clear = {n for n, m in here.items() if is_clear(m, ranges, self._profile)}
        starts = visible(here, self._profile, self._profile.s_via_min, clear)
        closed = self._experience.unreachable
        ways = {
            node: cost + self._avoid.get(node, 0.0) for node, cost in starts.items() if node not in closed
        }
        banned = self._experience.banned
        path = plan_path(self._maps.graph, ways, self._targets, self._profile, self._doubted, banned)
        if path:
            self._search = None
            self._follow([*path, GOAL])
            return None
        if starts:
            return self._no_way()
        return self._look_for_map(ranked(here, self._profile)[:1])

    def _no_way(self) -> Decision:
        """Known places are in sight, but every path is closed."""
        self._lost += 1
        banned = len(self._experience.banned)
        why = f"no path from here to the goal, {banned} legs failed in this mission"
        if self._experience.forgive():
            return Decision("hold", why=why, notes=(Note("second_try", f"{why}: all are tried once more"),))
        if self._lost <= MAX_LOST and not banned:
            return Decision("hold", why=why)
        return self._end("failed", "blocked" if banned else "no_path", why, ())

    def _look_for_map(self, nearest: list[tuple[int, NodeMatch]]) -> Decision:
        """Lost: towards what resembles a place most, else in sweeps that grow."""
        if self._search is None:
            self._search = search_back(self._last_heading_rad, SEARCH_STEPS)
        s_nearest = similarity(nearest[0][1], self._profile) if nearest else 0
        if self._search.exhausted:
            why = f"nothing known found in {SEARCH_STEPS} steps, best similarity {s_nearest}"
            return self._end("failed", "lost", why, ())
        heading_rad = self._search.next_heading()
        if nearest and nearest[0][1].heading_rad is not None:
            heading_rad = nearest[0][1].heading_rad
        why = f"looking for a place I know, best similarity {s_nearest}"
        return Decision("go", heading_rad, 0, 1.0, "searching", why)

    def _locate_goal(self) -> dict[int, float]:
        """Places the goal resembles, with the cost of the last leg from each."""
        found = self._matcher.locate(self._goal, LOCALISE_K)
        nodes = self._maps.graph.nodes
        clear = {n for n, m in found.items() if n in nodes and is_clear_from(nodes[n], m, self._profile)}
        return visible(found, self._profile, self._profile.s_edge_min, clear)

    def _in_sight(self, match: NodeMatch, ranges: Ranges) -> bool:
        seen = trusted(match, self._profile) and is_clear(match, ranges, self._profile)
        return seen and similarity(match, self._profile) > self._profile.s_edge_min

    def _follow(self, path: list[int]) -> None:
        target = Target(self._goal, self._profile.arrival_rad, self._look_alike)
        self._follower = PathFollower(
            self._profile, self._maps, path, target, self._doubted, self._experience
        )

    def _recover(self, state: str, decision: Decision, notes: tuple[Note, ...]) -> Decision:
        """Give up the edge that failed and plan again from what is seen now."""
        assert self._follower is not None
        if state == "unclear":
            return self._doubt(self._follower.next_leg(), decision, notes)
        ends, via = self._follower.failed_leg()
        if via == GOAL and ends is not None:
            self._blame_last_leg(self._follower.path[-2])
        self._follower = None
        self._avoid[via] = self._avoid.get(via, 0.0) + 0.5
        notes += (*decision.notes, Note("replan", f"{state}: {decision.why}"))
        ends = ends if ends is None or GOAL not in ends else None
        if state == "stuck":
            notes += self._experience.stuck(ends, via)
            self._stuck += 1
            if self._stuck > MAX_STUCK:
                return self._end("failed", "blocked", decision.why, notes)
        elif ends is not None:
            self._suspect = (ends, state)
        if state != "stuck":
            self._lost += 1
            self._last = self._last if self._lost == 1 else None
            if self._lost > MAX_LOST:
                kind: FailureKind = "blocked" if self._experience.banned else "lost"
                return self._end("failed", kind, decision.why, notes)
        return Decision("hold", why=f"planning again: {decision.why}", notes=notes)

    def _blame_last_leg(self, last: int) -> None:
        """The goal was not found from its last place: those on its other sides come first now."""
        if self._targets is not None and last in self._targets:
            self._targets[last] += LAST_LEG_RAD

    def _doubt(self, doubted: Leg, decision: Decision, notes: tuple[Note, ...]) -> Decision:
        """No free ground is seen along a leg: plan again with it as the last resort."""
        self._doubted.add(doubted)
        self._follower = None
        notes += (*decision.notes, Note("leg_doubted", f"leg {doubted}: {decision.why}"))
        return Decision("hold", why=f"planning again: {decision.why}", notes=notes)

    def _end(self, outcome: str, kind: FailureKind, why: str, notes: tuple[Note, ...]) -> Decision:
        return Decision(
            "hold",
            why=why,
            notes=notes,
            outcome="succeeded" if outcome == "succeeded" else "failed",
            failure=kind,
        )


def _with_notes(decision: Decision, notes: tuple[Note, ...]) -> Decision:
    return replace(decision, notes=notes + decision.notes) if notes else decision
