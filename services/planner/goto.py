"""Mission goto: drive to where a picture was taken (thesis sections 4.1 and 4.3)."""

from services.planner.following import Leg, PathFollower, Target
from services.planner.ports import GOAL, Decision, MapAccess, Matcher, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.routing import plan_path, visible
from services.planner.similarity import ranked, similarity, trusted
from services.planner.surroundings import is_clear, is_clear_from
from shared.messages.features import Features
from shared.messages.maps import DeleteEdge, PutEdge
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges

LOCALISE_K = 8
MAX_LOST = 12
MAX_STUCK = 12


class Goto:
    """Localise current and target frame, plan, follow, replan; ends with arrival or a typed failure."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, goal: Features) -> None:
        self._profile, self._maps, self._matcher, self._goal = profile, maps, matcher, goal
        self._targets: dict[int, float] | None = None
        self._follower: PathFollower | None = None
        self._lost = self._stuck = 0
        self._avoid: dict[int, float] = {}
        self._doubted: set[Leg] = set()
        self.progress = Progress()

    def decide(self, observation: Observation) -> Decision:
        """One step; the frame itself is already with the matcher."""
        notes: tuple[Note, ...] = ()
        if self._targets is None:
            self._targets = self._locate_goal()
            notes = (Note("goal_located", f"goal resembles nodes {sorted(self._targets)}"),)
        if self._follower is None:
            failed = self._plan(observation.ranges)
            if failed is not None:
                return failed
        assert self._follower is not None
        state, decision = self._follower.step(observation, self._matcher)
        self.progress = self._follower.progress
        if state == "arrived":
            return self._end("succeeded", "", decision.why, notes + decision.notes)
        if state == "going":
            return _with_notes(decision, notes)
        return self._recover(state, decision, notes)

    def _plan(self, ranges: Ranges) -> Decision | None:
        """Set a follower, or return how the mission goes on without one."""
        assert self._targets is not None
        here = self._matcher.match([], LOCALISE_K, (self._goal,))
        seen_goal = here.pop(GOAL, None)
        if seen_goal is not None and not self._stuck and self._in_sight(seen_goal, ranges):
            self._follow([GOAL])
            return None
        if not self._targets:
            return self._end("failed", "goal_not_in_map", "the goal resembles no place of the map", ())
        clear = {n for n, m in here.items() if is_clear(m, ranges, self._profile)}
        starts = visible(here, self._profile, self._profile.s_via_min, clear)
        starts = {node: cost + self._avoid.get(node, 0.0) for node, cost in starts.items()}
        path = plan_path(self._maps.graph, starts, self._targets, self._profile, self._doubted)
        if path:
            self._follow([*path, GOAL])
            return None
        self._lost += 1
        nearest = ranked(here, self._profile)[:1]
        s_nearest = similarity(nearest[0][1], self._profile) if nearest else 0
        if self._lost > MAX_LOST:
            kind: FailureKind = "no_path" if starts else "lost"
            return self._end("failed", kind, f"no path from here, best similarity {s_nearest}", ())
        why = f"looking for a place I know, best similarity {s_nearest}"
        heading = nearest[0][1].heading_rad if nearest else None
        return Decision("go", heading if heading is not None else 0.0, 0, 1.0, "searching", why)

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
        target = Target(self._goal, self._profile.arrival_rad)
        self._follower = PathFollower(self._profile, self._maps, path, target, self._doubted)

    def _recover(self, state: str, decision: Decision, notes: tuple[Note, ...]) -> Decision:
        """Give up the edge that failed and plan again from what is seen now."""
        assert self._follower is not None
        if state == "unclear":
            return self._doubt(self._follower.next_leg(), decision, notes)
        ends = self._follower.current_leg()
        via = self._follower.path[self._follower.index]
        self._follower = None
        self._avoid[via] = self._avoid.get(via, 0.0) + 0.5
        notes += (*decision.notes, Note("replan", f"{state}: {decision.why}"))
        if ends is not None and GOAL not in ends:
            notes += (self._give_up(ends, state),)
        if state == "stuck":
            self._stuck += 1
            if self._stuck > MAX_STUCK:
                return self._end("failed", "blocked", decision.why, notes)
        else:
            self._lost += 1
            if self._lost > MAX_LOST:
                return self._end("failed", "lost", decision.why, notes)
        return Decision("hold", why=f"planning again: {decision.why}", notes=notes)

    def _doubt(self, doubted: Leg, decision: Decision, notes: tuple[Note, ...]) -> Decision:
        """No free ground is seen along a leg: plan again with it as the last resort."""
        self._doubted.add(doubted)
        self._follower = None
        notes += (*decision.notes, Note("leg_doubted", f"leg {doubted}: {decision.why}"))
        return Decision("hold", why=f"planning again: {decision.why}", notes=notes)

    def _give_up(self, ends: tuple[int, int], why: str) -> Note:
        """Thesis: delete after one bad frame (equation 6.4); default: count, and suspend the second time."""
        edge = self._maps.graph.edge(*ends)
        if edge is None:
            return Note("edge_gone", f"edge {ends} is no longer in the map")
        if self._profile.delete_edges:
            self._maps.commit([DeleteEdge(a=edge.a, b=edge.b)])
            return Note("edge_deleted", f"edge {ends}: {why}")
        failures = edge.failures + 1
        suspended = failures >= 2 and edge.traversals == 0
        update = {"failures": failures, "suspended": suspended, "why": f"{why} while driving"}
        self._maps.commit([PutEdge(edge=edge.model_copy(update=update))])
        return Note("edge_suspended" if suspended else "edge_failed", f"edge {ends}: {why}")

    def _end(self, outcome: str, kind: FailureKind, why: str, notes: tuple[Note, ...]) -> Decision:
        return Decision(
            "hold",
            why=why,
            notes=notes,
            outcome="succeeded" if outcome == "succeeded" else "failed",
            failure=kind,
        )


def _with_notes(decision: Decision, notes: tuple[Note, ...]) -> Decision:
    if not notes:
        return decision
    return Decision(
        decision.action,
        decision.heading_rad,
        decision.s_cv,
        decision.speed_fraction,
        decision.method,
        decision.why,
        notes + decision.notes,
    )
