"""The one mission of a robot: started, paused, stepped and ended; kept by the map store across restarts."""

import logging
import uuid
from contextlib import suppress
from typing import Any

import numpy as np

from services.planner.inspector import RemoteInspector
from services.planner.mission_kinds import MissionContext, MissionError, MissionKinds
from services.planner.ports import Accompanying, Decision, Mission, Observation, Progress
from services.planner.profiles import Profile
from services.planner.remote import RemoteMap, RemoteMatcher
from services.planner.settings import PlannerSettings
from services.planner.surroundings import at_speed
from services.planner.travel.whereabouts import Whereabouts
from shared.bus import Bus
from shared.mapgraph.frontiers import open_directions
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import MapDelta, MissionRecord, MissionRecordRequest
from shared.messages.missions import (
    CONTROLS,
    EventValue,
    FailureKind,
    MissionRequest,
    MissionState,
    MissionStatus,
    PausedBy,
)
from shared.queries import QueryError, RefusedError
from shared.topics import MISSION_RECORD
from shared.wire import WireError

log = logging.getLogger(__name__)


class MissionControl:
    """State machine of missions: idle, running, paused, then succeeded, failed or cancelled."""

    def __init__(self, settings: PlannerSettings, profile: Profile, kinds: MissionKinds, bus: Bus) -> None:
        self._settings, self._profile, self._kinds, self._bus = settings, profile, kinds, bus
        self._record = MissionRecord(robot=settings.robot)
        self._mission: Mission | None = None
        self._matcher: RemoteMatcher | None = None
        self.map: RemoteMap | None = None
        self.state: MissionState = "idle"
        self._paused_by: PausedBy = ""
        self._failure: FailureKind = ""
        self._reason = ""
        self._known = MapGraph()
        self._whereabouts = Whereabouts()
        self.step_count = 0
        self._got_on_at = 0
        self._unsaved: MissionRecord | None = None

    @property
    def epoch(self) -> int:
        """This planner's lease number."""
        return self._record.epoch

    @property
    def goes_along(self) -> bool:
        """Whether the mission goes along with a person who drives, instead of waiting for its turn."""
        return isinstance(self._mission, Accompanying)

    @property
    def step_costs_ms(self) -> dict[str, float]:
        """Time the feature service spent on the questions of the last step, by stage."""
        matcher = self._matcher
        return {} if matcher is None else {"match_ms": matcher.match_ms, "verify_ms": matcher.verify_ms}

    def claim(self) -> None:
        """Take over from a planner before; goes on with its mission. QueryError while the store is away."""
        request = MissionRecordRequest(action="claim", record=self._record)
        self._record = self._bus.ask(
            MISSION_RECORD, request, self._settings.map_timeout_s, robot=self._settings.robot
        )
        log.info("claimed epoch %d", self.epoch)
        if self._record.action:
            self._go_on()
        elif self._record.outcome:
            self._remember_end()

    def handle(self, request: MissionRequest) -> MissionStatus:
        """Follow a request and return the status after it; MissionError says why not."""
        if request.action not in CONTROLS:
            self._start(request)
        elif request.action != "status":
            if request.mission_id not in ("", self._record.mission_id):
                why = (
                    f"mission {request.mission_id} is not the one of now, that is {self._record.mission_id!r}"
                )
                raise MissionError(why, "conflict")
            self._change(request.action, "person")
        return self.status()

    def pause(self, reason: str, by: PausedBy) -> None:
        """Pause a running mission for a reason that the status then gives."""
        self._reason = reason
        self._change("pause", by)

    def settle(self) -> None:
        """Save an end that the map store was not there to hear of; QueryError while it is away."""
        if self._unsaved is not None:
            self._save(self._unsaved)
            self._unsaved = None

    def step(self, observation: Observation) -> Decision:
        """Decide for one frame of a running mission."""
        assert self._mission is not None
        assert self._matcher is not None
        assert self.map is not None
        self._matcher.begin(observation.features.seq, observation.features.stamp_ns)
        if (lost := self._notice_lost_nodes()) is not None:
            decision = lost
        elif self.step_count - self._got_on_at >= self._record.max_steps:
            why = f"not done within {self._record.max_steps} steps"
            decision = Decision("hold", why=why, outcome="failed", failure="timeout")
        else:
            decision = self._mission.decide(observation)
            progress = self._mission.progress
            self._keep_checkpoint(progress)
            decision = at_speed(decision, self.map.graph, progress.nearest_node, self._profile)
        self.step_count += 1
        self._reason = decision.why
        if decision.outcome:
            self._finish(decision.outcome, decision.failure, decision.why)
        return decision

    def status(self) -> MissionStatus:
        """What is published after every step."""
        progress = self._mission.progress if self._mission is not None else Progress()
        graph = self.map.graph if self.map is not None else MapGraph()
        facts = {
            "nodes": len(graph.nodes),
            "edges": len(graph.edges),
            "open_directions": open_directions(graph),
            "similarity": progress.similarity,
            "disparity_rad": progress.disparity_rad,
        }
        return MissionStatus(
            robot=self._settings.robot,
            mission_id=self._record.mission_id,
            action=self._record.action,
            map=self._record.map,
            state=self.state,
            failure=self._failure,
            reason=self._reason[:400],
            step=self.step_count,
            via_points=progress.via_points,
            via_index=progress.via_index,
            nearest_node=progress.nearest_node,
            epoch=self.epoch,
            paused_by=self._paused_by if self.state == "paused" else "",
            travel=progress.travel,
            travel_reason=progress.travel_reason,
            figures=self._figures({**facts, **progress.figures}),
            **facts,
        )

    def follow_store(self, delta: MapDelta) -> None:
        """A map changed: follow, if it is this one and somebody else did it. One gone ends the mission."""
        if self.map is None or delta.map != self.map.name:
            return
        if delta.renamed_to:
            log.info("map %s is called %s now", self.map.name, delta.renamed_to)
            self.map.name = self._whereabouts.map = delta.renamed_to
            self._record = self._record.model_copy(update={"map": delta.renamed_to})
            return
        if delta.revision <= self.map.revision and not delta.reset:
            return
        try:
            self.map.follow(delta)
        except RefusedError as error:
            if error.code != "missing":
                raise
            if self.state in ("running", "paused"):
                self._lose_map(error)

    def _go_on(self) -> None:
        """Go on with the mission of a planner before; one that cannot go on has failed."""
        try:
            self._begin(self._record, create=False)
        except MissionError as error:
            self._finish("failed", "service_lost", f"cannot go on after a restart: {error}")
            return
        except RefusedError as error:
            if error.code != "missing":
                raise
            self._lose_map(error)
            return
        self.state = "paused" if self._record.paused else "running"
        self._paused_by = self._record.paused_by
        self._reason = "taken over after a restart"

    def _remember_end(self) -> None:
        """Say how the last mission ended: the planner before may have died before anybody heard of it."""
        ended = self._record
        self._record = ended.model_copy(update={"action": ended.ended_action})
        self.state, self._failure, self._reason = ended.outcome or "idle", ended.failure, ended.reason
        self.step_count = ended.step
        self.map = RemoteMap(self._bus, ended.map, self._settings.map_timeout_s)
        with suppress(RefusedError):  # deleted since
            self.map.load(create=False)

    def _figures(self, values: dict[str, float | int | str | bool | None]) -> tuple[EventValue, ...]:
        """What the kind's record shows; of a kind that is not known here nothing."""
        with suppress(MissionError):
            shown = self._kinds[self._record.action].shown
            return tuple(EventValue(name=name, value=values[name]) for name in shown if name in values)
        return ()

    def _lose_map(self, error: RefusedError) -> None:
        kind: FailureKind = "goal_not_in_map" if self._has_goal() else "lost"
        self._finish("failed", kind, f"the map is gone: {error}")

    def _has_goal(self) -> bool:
        return self._record.goal is not None or not {"goal_node", "place"}.isdisjoint(
            _parameters(self._record)
        )

    def _notice_lost_nodes(self) -> Decision | None:
        """Somebody took nodes away: plan anew, from what is left, and never lead to one that is gone.

        Returns the end of a mission whose goal is among them.
        """
        assert self.map is not None
        assert self._matcher is not None
        if self._known is self.map.graph:  # only reading the map again makes another graph
            return None
        lost = self._known.nodes.keys() - self.map.graph.nodes.keys()
        if not lost:
            self._known = self.map.graph
            return None
        why = f"nodes {sorted(lost)[:8]} were taken out of the map"
        try:
            self._mission = self._make(self._record, self.map, self._matcher)
        except MissionError as error:
            return Decision("hold", why=f"{why}: {error}", outcome="failed", failure=error.failure)
        log.info("%s: planning anew", why)
        self._known = self.map.graph
        return None

    def _start(self, request: MissionRequest) -> None:
        if self.state in ("running", "paused"):
            why = f"mission {self._record.mission_id} is {self.state}; cancel it first"
            raise MissionError(why, "conflict")
        self.settle()
        record = MissionRecord(
            robot=self._settings.robot,
            epoch=self.epoch,
            mission_id=request.mission_id or uuid.uuid4().hex[:12],
            action=request.action,
            map=request.map,
            parameters=request.parameters,
            checkpoint=request.checkpoint,
            goal=request.goal,
            goal_node=request.goal_node,
            seed=request.seed,
            max_steps=request.max_steps,
        )
        before = self._mission, self._record, self.map, self._matcher, self._known, self._whereabouts
        self._begin(record, create=self._kinds[record.action].makes_map)
        try:
            self._save()
        except (QueryError, WireError):
            self._mission, self._record, self.map, self._matcher, self._known, self._whereabouts = before
            raise
        self.state, self._failure, self._reason, self.step_count = "running", "", "started", 0
        self._got_on_at = 0

    def _begin(self, record: MissionRecord, *, create: bool) -> None:
        """Take up a mission; one that cannot be leaves everything as it was."""
        maps = RemoteMap(self._bus, record.map, self._settings.map_timeout_s)
        maps.load(create=create)
        matcher = RemoteMatcher(self._bus, record.robot, maps, self._settings.query_timeout_s)
        self._mission = self._make(record, maps, matcher)
        self._record, self.map, self._matcher, self._known = record, maps, matcher, maps.graph

    def _make(self, record: MissionRecord, maps: RemoteMap, matcher: RemoteMatcher) -> Mission:
        rng = np.random.default_rng(record.seed)
        whereabouts = self._whereabouts.of(record.map)
        timeout_s = self._settings.map_timeout_s
        inspector = RemoteInspector(self._bus, maps, matcher, record.mission_id, timeout_s)
        context = MissionContext(
            self._profile, maps, matcher, rng, record.goal, whereabouts, inspector, record.checkpoint
        )
        mission = self._kinds[record.action].start(context, _parameters(record))
        self._whereabouts = whereabouts
        return mission

    def _change(self, action: str, by: PausedBy) -> None:
        if action == "pause" and by == "person" and self._waits_for_stop():
            self._save_pause(by)  # it stays paused when the stop is cleared
            return
        under_way = ("running", "paused")
        allowed = {"pause": ("running",), "resume": ("paused",)}.get(action, under_way)
        if self.state not in allowed:
            why = f"{action} needs a mission that is {' or '.join(allowed)}, it is {self.state}"
            raise MissionError(why, "conflict")
        if action == "cancel":
            self._finish("cancelled", "cancelled", "cancelled by request")
            return
        if action == "finish":
            self._end_well()
            return
        self.state = "paused" if action == "pause" else "running"
        self._save_pause(by if action == "pause" else "")

    def _end_well(self) -> None:
        """A person says that a mission which goes along has done its work."""
        if not isinstance(self._mission, Accompanying):
            why = f"{self._record.action} ends by itself; cancel it, or wait for its end"
            raise MissionError(why, "conflict")
        self._finish("succeeded", "", self._mission.finish())

    def _waits_for_stop(self) -> bool:
        return self.state == "paused" and self._paused_by == "emergency_stop"

    def _save_pause(self, by: PausedBy) -> None:
        self._paused_by = by
        self._record = self._record.model_copy(update={"paused": bool(by), "paused_by": by})
        self._save()

    def _finish(self, state: MissionState, failure: FailureKind, reason: str) -> None:
        self.state, self._failure, self._reason = state, failure, reason
        ended = MissionRecord(
            robot=self._record.robot,
            epoch=self.epoch,
            mission_id=self._record.mission_id,
            map=self._record.map,
            seed=self._record.seed,
            max_steps=self._record.max_steps,
            step=self.step_count,
        )
        how = {"ended_action": self._record.action, "outcome": state, "failure": failure}
        self._unsaved = ended.model_copy(update={**how, "reason": reason[:400]})
        self.settle()

    def _keep_checkpoint(self, progress: Progress) -> None:
        """What a mission has done is on record before the robot does what comes next."""
        checkpoint = dict(progress.checkpoint)
        if checkpoint != self._record.checkpoint:
            record = self._record.model_copy(update={"checkpoint": checkpoint})
            self._save(record)
            self._record = record
            self._got_on_at = self.step_count  # a round without an end may take as long as it gets on

    def _save(self, record: MissionRecord | None = None) -> None:
        request = MissionRecordRequest(action="save", record=record or self._record)
        self._bus.ask(MISSION_RECORD, request, self._settings.map_timeout_s, robot=self._settings.robot)


def _parameters(record: MissionRecord) -> dict[str, Any]:
    """Of the mission, with the goal node of a sender or a record that knows no parameters."""
    node = {} if record.goal_node is None else {"goal_node": record.goal_node}
    return {**record.parameters, **node}
