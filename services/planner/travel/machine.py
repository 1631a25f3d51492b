"""The travel machine: localises, plans, follows, loses and finds itself again (thesis sections 4.1 to 4.3).

`states.py` has its states and transitions. A mission gives it a `Destination` and asks it for one decision a
frame.
"""

import logging
from dataclasses import replace

from services.planner.ports import Decision, MapAccess, Matcher, Matches, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity
from services.planner.travel.destination import Destination, Setback
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.following.path_follower import PathFollower
from services.planner.travel.localisation import (
    allowed_starts,
    allowed_targets,
    edge_cost,
    in_sight,
    starts_in_sight,
)
from services.planner.travel.search import Search, search_back
from services.planner.travel.states import TRANSITIONS, Event, State
from services.planner.travel.tracking import Tracker
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.graph import EdgeKey
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.keep_clear import is_near_forbidden
from shared.mapgraph.routing import GOAL, plan_path
from shared.messages.missions import FailureKind

log = logging.getLogger(__name__)

HELD_FRAMES = 10
"""Frames in which rules leave no way before the travel ends; chosen: 3 s, time for a frame that was wrong."""


class Travel:
    """One robot on its way; ends as ARRIVED or FAILED.

    Attributes:
        state: what it is doing.
        reason: of the last transition.
        last_heading_rad: where the robot came from, turned round: a lost one first goes back.
    """

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        destination: Destination,
        experience: EdgeExperience,
        whereabouts: Whereabouts | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._destination, self._experience = destination, experience
        self.state, self.reason = State.LOCALISING, ""
        self.last_heading_rad = 0.0
        certain = destination.picture is None
        self.tracker = Tracker(profile, maps, matcher, certain=certain, whereabouts=whereabouts)
        self._unclear: set[EdgeKey] = set()
        self._follower: PathFollower | None = None
        self._search: Search | None = None
        self._notes: list[Note] = []
        self._held_frames = 0
        self._makes_room = False
        self._progress = Progress()

    @property
    def progress(self) -> Progress:
        """Where the travel stands, for the mission's status."""
        return replace(self._progress, travel=self.state.value, travel_reason=self.reason)

    def set_out(self, here: Displacement) -> None:
        """The robot stands at a node and will want a new destination."""
        self._change(Event.SET_OUT)
        self._search = None
        self.tracker.stand_at(here)

    def observe(self, observation: Observation) -> None:
        """A new frame: directions are kept in the robot's frame, which turned."""
        self.tracker.observe(observation)
        self.last_heading_rad = observation.moved.direction(self.last_heading_rad)
        if self._search is not None:
            self._search.turned(observation.moved.turn_rad)

    def step(self, observation: Observation) -> Decision:
        """One frame; the matcher has it already."""
        self._notes = []
        self.observe(observation)
        self._obey()
        decision = None if self.state is State.FOLLOWING else self._find_way(observation)
        if decision is None:
            decision = self._follow(observation)
        return replace(decision, notes=(*self._notes, *decision.notes))

    def _find_way(self, observation: Observation) -> Decision | None:
        """Localise and plan; None once there is a path to follow."""
        destination, graph, profile = self._destination, self._maps.graph, self._profile
        limits = self._maps.limits()
        pictures = () if destination.picture is None else (destination.picture,)
        nodes = list(dict.fromkeys([*self.tracker.nearby(), *self.tracker.elsewhere]))
        seen = self._matcher.match(nodes, destination.compared, pictures)
        goal = seen.pop(GOAL, None)
        seen = self.tracker.possible(seen, of_map=True)
        self.tracker.confirm(seen)
        if self.tracker.mistaken:
            self._notes += destination.mistaken()
        self._notes += destination.localised(seen, observation.ranges)
        if goal is not None and destination.sees(goal, self.tracker.here):
            in_view = in_sight(goal, graph, observation.ranges, profile)
            free = in_view and not is_near_forbidden(graph, self.tracker.here, limits.forbidden)
            if free and destination.goes_straight():
                self._set_off([GOAL], Event.GOAL_IN_SIGHT)
                return None
        wanted = destination.targets()
        if not wanted:
            return self._give_up(*destination.unreachable())
        targets = allowed_targets(wanted, graph, destination.lies, limits)
        if not targets:
            return self._give_up("forbidden", limits.why_not(wanted))
        visible = starts_in_sight(seen, graph, observation.ranges, profile)
        within = next((limits.forbidden[node] for node in visible if node in limits.forbidden), "")
        if within and visible.keys() <= limits.forbidden.keys():
            return self._held_back(f"all that is in sight is forbidden by rule {within!r}")
        starts = destination.starts(allowed_starts(visible, graph, self.tracker.here, limits))
        banned = self._experience.banned
        path = plan_path(graph, starts, targets, edge_cost(graph, profile), self._unclear, banned, limits)
        if path:
            self._held_frames = 0
            destination.set_out()
            path += destination.beyond(path[-1])
            self._set_off([*path, GOAL] if pictures else path, Event.PATH_FOUND)
            return None
        if not starts:
            return self._look_around(seen, observation.frame_share)
        open_path = plan_path(graph, starts, targets, edge_cost(graph, profile), self._unclear, banned)
        if pictures and (rule := limits.against_path(open_path)):
            return self._held_back(f"every path to the goal is against rule {rule!r}")
        return self._wait()

    def _obey(self) -> None:
        """Leave a path that a rule is against, which may have come or begun to hold on the way."""
        if self.state is not State.FOLLOWING or self._follower is None:
            return
        ahead = self._follower.position.remaining
        limits = self._maps.limits()
        rule = limits.forbidden.get(ahead[-1], "") or limits.against_path(ahead)
        if rule:
            self._notes.append(Note("ruled_out", f"rule {rule!r} is against going on to {ahead[-1]}"))
            self._change(Event.RULED_OUT)

    def _held_back(self, why: str) -> Decision:
        """A rule leaves no way: after some frames that all say so, the travel ends."""
        self._change(Event.NO_PATH)
        self._held_frames += 1
        if self._held_frames > HELD_FRAMES:
            return self._give_up("forbidden", f"{why}: drive the robot by hand, or lift the rule")
        return Decision("hold", why=why)

    def _set_off(self, path: list[int], event: Event) -> None:
        self._change(event)
        self._search, self._makes_room = None, event is Event.MAKES_ROOM
        self._follower = PathFollower(
            self._profile,
            self._maps,
            path,
            self._destination,
            self._unclear,
            self._experience,
            self.tracker,
        )

    def _follow(self, observation: Observation) -> Decision:
        follower = self._follower
        assert follower is not None
        if self._maps.shared and (waiting := self._give_way(follower)) is not None:
            return waiting
        event, decision = follower.step(observation, self._matcher)
        self._progress = follower.progress
        if self.tracker.mistaken:
            self._notes += (*decision.notes, *self._destination.mistaken())
            self._change(Event.MISTAKEN)
            return Decision("hold", why="planning again: this is another place")
        if event is None:
            self.last_heading_rad = decision.heading_rad
            share = self._maps.limits().speed_share(*follower.position.leg)
            return replace(decision, speed_fraction=share * decision.speed_fraction)
        self._notes += decision.notes
        why = decision.why
        if event is Event.WAY_UNCLEAR:
            self._unclear.add(follower.position.next_edge)
        if self._makes_room:  # go on from the refuge, or from where the way there does not let it get on
            self._change(Event.MADE_ROOM if event is Event.REACHED else event)
            return Decision("hold", why=why)
        if event is Event.REACHED:
            refuted = self._destination.refutes_arrival(
                follower.position.path[-1], self._progress.similarity, self.tracker
            )
            if not refuted:
                self._change(event)
                return Decision("hold", why=why)
            event, why = Event.ALIASED, f"{why}, {refuted}"
        self._change(event)
        if event is Event.WAY_UNCLEAR:
            self._notes.append(Note("leg_doubted", f"edge {follower.position.next_edge}: {why}"))
            return Decision("hold", why=f"planning again: {why}")
        here = self.tracker.here
        return self._recover(
            Setback(event, *follower.failed_edge(), tuple(follower.position.path), why, here)
        )

    def _give_way(self, follower: PathFollower) -> Decision | None:
        """Ask for the nodes ahead; a decision where the robot waits for others, or makes room for them."""
        way = self._maps.right_of_way(*follower.way())
        if way.room and not self._makes_room:
            self._notes.append(Note("makes_room", f"by way of {list(way.room[:8])}"))
            self._set_off(list(way.room), Event.MAKES_ROOM)
            return Decision("hold", why="making room for others")
        follower.may_go(way.free)
        return Decision("hold", why=f"waits: {way.why}") if follower.position.waits else None

    def _recover(self, setback: Setback) -> Decision:
        """Learn from what ended the path, and plan again from what the next frame shows."""
        log.info("%s on the way %s: %s", setback.event.value, setback.path[:8], setback.why)
        verdict = self._destination.setback(setback)
        self._notes += verdict.notes
        if verdict.failure:
            return self._give_up(verdict.failure, setback.why)
        if self.tracker.mistaken:
            self._notes += self._destination.mistaken()
        return Decision("hold", why=f"planning again: {setback.why}")

    def _wait(self) -> Decision:
        self._change(Event.NO_PATH)
        verdict = self._destination.no_path()
        self._notes += verdict.notes
        if verdict.failure:
            return self._give_up(verdict.failure, verdict.why)
        return Decision("hold", why=verdict.why)

    def _look_around(self, here: Matches, frame_share: float) -> Decision:
        """Lost mode (thesis section 4.2): towards what resembles a node most, else in growing sweeps."""
        self._change(Event.NOTHING_KNOWN)
        patience = self._destination.search_steps
        if self._search is None:
            self._search = search_back(self.last_heading_rad, patience)
        nearest = ranked(here, self._profile)[:1]
        s_nearest = similarity(nearest[0][1], self._profile) if nearest else 0
        if self._search.exhausted:
            why = f"no node of the map recognised in {patience} steps, best similarity {s_nearest}"
            return self._give_up("lost", why)
        heading_rad = self._search.next_heading(frame_share)
        if nearest and nearest[0][1].heading_rad is not None:
            heading_rad = nearest[0][1].heading_rad
        why = f"looking for a node I know, best similarity {s_nearest}"
        return Decision("go", heading_rad, 0, 1.0, "search", why)

    def _give_up(self, failure: FailureKind, why: str) -> Decision:
        """End the travel; one that is lost is not where it believed, and the next mission asks the map."""
        if failure == "lost":
            self.tracker.stand_at(None)
        self._change(Event.GIVEN_UP)
        return Decision("hold", why=why, outcome="failed", failure=failure)

    def _change(self, event: Event) -> None:
        """Take the transition of the table; there is none for an event that this state does not know."""
        transition = TRANSITIONS[self.state, event]
        self.state, self.reason = transition.after, transition.reason
