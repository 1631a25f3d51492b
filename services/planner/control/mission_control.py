"""The state machine of a robot's one mission: started, paused, stepped and ended."""

import logging
from contextlib import suppress
from dataclasses import replace

from services.planner.control.assignment import Assigner, Assignment
from services.planner.control.records import MissionRecords, begun, ended, has_goal
from services.planner.control.standing import Standing, status_of
from services.planner.mission_kinds import MissionError
from services.planner.ports import Accompanying, Decision, Mission, Observation, Progress
from services.planner.remote.remote_map import RemoteMap
from services.planner.surroundings import at_speed
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import MapDelta, MissionRecord
from shared.messages.missions import (
    CONTROLS,
    FailureKind,
    MissionRequest,
    MissionState,
    MissionStatus,
    PausedBy,
)
from shared.queries import RefusedError

log = logging.getLogger(__name__)


class MissionControl:
    """State machine of missions: idle, running, paused, then succeeded, failed or cancelled."""

    def __init__(self, assigner: Assigner, records: MissionRecords) -> None:
        self._assigner, self._records = assigner, records
        self._record = MissionRecord(robot=records.robot)
        self._assignment: Assignment | None = None  # stays when its mission has ended
        self._ended_in: RemoteMap | None = None  # map of a mission that a planner before ended
        self._now = Standing()
        self._got_on_at = 0

    @property
    def epoch(self) -> int:
        """This planner's lease number."""
        return self._record.epoch

    @property
    def state(self) -> MissionState:
        """Of the mission."""
        return self._now.state

    @property
    def step_count(self) -> int:
        """Frames that the mission decided for."""
        return self._now.step

    @property
    def map(self) -> RemoteMap | None:
        """Of the mission, or of the last one; None before any."""
        return self._ended_in if self._assignment is None else self._assignment.map

    @property
    def goes_along(self) -> bool:
        """Whether the mission goes along with a person who drives, instead of waiting for its turn."""
        return isinstance(self._mission, Accompanying)

    @property
    def step_costs_ms(self) -> dict[str, float]:
        """Time the feature service spent on the questions of the last step, by stage."""
        if self._assignment is None:
            return {}
        matcher = self._assignment.matcher
        return {"match_ms": matcher.match_ms, "verify_ms": matcher.verify_ms}

    @property
    def _mission(self) -> Mission | None:
        return None if self._assignment is None else self._assignment.mission

    @property
    def _node(self) -> int | None:
        """At which the robot is, as its last mission left it; None while nobody knows."""
        here = None if self._assignment is None else self._assignment.whereabouts.here
        return None if here is None else here.node_id

    def claim(self) -> None:
        """Take over from a planner before; goes on with its mission. QueryError while the store is away."""
        self._record = self._records.claim(self._record)
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
        self._now.reason = reason
        self._change("pause", by)

    def stand_in_traffic(self) -> None:
        """Say now and then where the robot is, also while it stands: others go round it or have it go."""
        if self.map is None:
            return
        at = () if self._node is None else (self._node,)
        drives = self._now.state == "running"
        self._assigner.traffic.renew(self.map.name, at, busy=self._now.under_way, drives=drives)

    def settle(self) -> None:
        """Save an end that the map store was not there to hear of; QueryError while it is away."""
        self._records.settle()

    def step(self, observation: Observation) -> Decision:
        """Decide for one frame of a running mission."""
        assert self._assignment is not None
        self._assignment.matcher.begin(observation.features.seq, observation.features.stamp_ns)
        if (lost := self._notice_lost_nodes(self._assignment)) is not None:
            decision = lost
        elif self._now.step - self._got_on_at >= self._record.max_steps:
            why = f"not done within {self._record.max_steps} steps"
            decision = Decision("hold", why=why, outcome="failed", failure="timeout")
        else:
            decision = self._decide(self._assignment, observation)
        self._now.step += 1
        self._now.reason = decision.why
        if decision.outcome:
            self._finish(decision.outcome, decision.failure, decision.why)
        return decision

    def status(self) -> MissionStatus:
        """What is published after every step."""
        progress = self._mission.progress if self._mission is not None else Progress()
        if progress.nearest_node is None:  # as of a robot that has arrived at a picture
            progress = replace(progress, nearest_node=self._node)
        graph = self.map.graph if self.map is not None else MapGraph()
        shown: tuple[str, ...] = ()
        with suppress(MissionError):  # of a kind that is not known here nothing is
            shown = self._assigner.kinds[self._record.action].shown
        return status_of(self._record, self._now, progress, graph, shown)

    def changes(self) -> list[MapDelta]:
        """What the map store has said of the map of the mission since the last call."""
        if self.map is not None:  # also where a mission could not begin in another one
            self._assigner.changes.follow(self.map.name)
        return self._assigner.changes.take_all()

    def follow_store(self, delta: MapDelta) -> None:
        """A map changed: follow, if it is this one and somebody else did it. One gone ends the mission."""
        if self.map is None or delta.map != self.map.name:
            return
        try:
            if delta.renamed_to:
                self._follow_name(self.map, delta.renamed_to)
            else:
                self.map.follow(delta)
        except RefusedError as error:
            if error.code != "missing":
                raise
            if self._now.under_way:
                self._lose_map(error)

    def _decide(self, assignment: Assignment, observation: Observation) -> Decision:
        decision, progress = assignment.mission.decide(observation), assignment.mission.progress
        self._keep_checkpoint(progress)
        return at_speed(decision, assignment.map.graph, progress.nearest_node, self._assigner.profile)

    def _follow_name(self, maps: RemoteMap, name: str) -> None:
        """Go on under the new name, unless an earlier map of this name was meant: the past is told, too."""
        revision = maps.revision
        try:
            maps.load(create=False)
        except RefusedError as error:
            if error.code != "missing":
                raise
            self._rename(maps, name)
            return
        if maps.revision < revision:  # it is a new one that has the name already
            self._rename(maps, name)
            maps.load(create=False)

    def _rename(self, maps: RemoteMap, name: str) -> None:
        log.info("map %s is called %s now", maps.name, name)
        maps.name = name
        if self._assignment is not None:
            self._assignment.whereabouts.map = name
        self._record = self._record.model_copy(update={"map": name})

    def _go_on(self) -> None:
        """Go on with the mission of a planner before; one that cannot go on has failed."""
        try:
            self._assignment = self._assigner.begin(self._record, self._assignment, create=False)
        except MissionError as error:
            self._finish("failed", "service_lost", f"cannot go on after a restart: {error}")
            return
        except RefusedError as error:
            if error.code != "missing":
                raise
            self._lose_map(error)
            return
        self._now.state = "paused" if self._record.paused else "running"
        self._now.paused_by = self._record.paused_by
        self._now.reason = "taken over after a restart"

    def _remember_end(self) -> None:
        """Say how the last mission ended: the planner before may have died before anybody heard of it."""
        last = self._record
        self._record = last.model_copy(update={"action": last.ended_action})
        self._now = Standing(last.outcome or "idle", last.failure, last.reason, step=last.step)
        self._ended_in = self._assigner.map_called(last.map)
        with suppress(RefusedError):  # deleted since
            self._ended_in.load(create=False)

    def _lose_map(self, error: RefusedError) -> None:
        kind: FailureKind = "goal_not_in_map" if has_goal(self._record) else "lost"
        self._finish("failed", kind, f"the map is gone: {error}")

    def _notice_lost_nodes(self, assignment: Assignment) -> Decision | None:
        """Somebody took nodes away: plan anew, from what is left, and never lead to one that is gone.

        Returns the end of a mission whose goal is among them.
        """
        if not (lost := assignment.lost_nodes()):
            return None
        why = f"nodes {lost[:8]} were taken out of the map"
        try:
            self._assignment = self._assigner.again(self._record, assignment)
        except MissionError as error:
            return Decision("hold", why=f"{why}: {error}", outcome="failed", failure=error.failure)
        log.info("%s: planning anew", why)
        return None

    def _start(self, request: MissionRequest) -> None:
        if self._now.under_way:
            why = f"mission {self._record.mission_id} is {self.state}; cancel it first"
            raise MissionError(why, "conflict")
        self.settle()
        record = begun(self._record, request)
        create = self._assigner.kinds[record.action].makes_map
        assignment = self._assigner.begin(record, self._assignment, create=create)
        self._records.save(record)
        self._assignment, self._record = assignment, record
        self._now = Standing("running", reason="started")
        self._got_on_at = 0

    def _change(self, action: str, by: PausedBy) -> None:
        if action == "pause" and by == "person" and self._now.waits_for_stop:
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
        self._now.state = "paused" if action == "pause" else "running"
        self._save_pause(by if action == "pause" else "")

    def _end_well(self) -> None:
        """A person says that a mission which goes along has done its work."""
        if not isinstance(self._mission, Accompanying):
            why = f"{self._record.action} ends by itself; cancel it, or wait for its end"
            raise MissionError(why, "conflict")
        self._finish("succeeded", "", self._mission.finish())

    def _save_pause(self, by: PausedBy) -> None:
        self._now.paused_by = by
        self._record = self._record.model_copy(update={"paused": bool(by), "paused_by": by})
        self._records.save(self._record)

    def _finish(self, state: MissionState, failure: FailureKind, reason: str) -> None:
        self._now.state, self._now.failure, self._now.reason = state, failure, reason
        self._records.end(ended(self._record, state, failure, reason, self._now.step))

    def _keep_checkpoint(self, progress: Progress) -> None:
        """What a mission has done is on record before the robot does what comes next."""
        checkpoint = dict(progress.checkpoint)
        if checkpoint != self._record.checkpoint:
            record = self._record.model_copy(update={"checkpoint": checkpoint})
            self._records.save(record)
            self._record = record
            self._got_on_at = self._now.step  # a round without an end may take as long as it gets on
