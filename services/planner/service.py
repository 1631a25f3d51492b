"""Planner loop: one decision per frame, requests in between."""

import logging
import threading
import time

from services.planner.control.assignment import Assigner
from services.planner.control.mission_control import MissionControl
from services.planner.control.records import MissionRecords
from services.planner.mission_kinds import MissionError, mission_kinds
from services.planner.odometry import FrameMotion
from services.planner.ports import Decision, Observation
from services.planner.profiles import Profile
from services.planner.settings import PlannerSettings
from shared.bus import Bus
from shared.messages.drive import Heading
from shared.messages.estop import EStopState
from shared.messages.features import Features
from shared.messages.missions import Event, EventValue, MissionKinds, MissionRequest, MissionStatus
from shared.messages.sensors import Ranges
from shared.queries import QueryError, RefusedError, Request
from shared.topics import (
    ESTOP_STATE,
    EVENT,
    FEATURES,
    HEADING,
    MANUAL,
    MISSION,
    MISSION_KINDS,
    ODOMETRY,
    RANGES,
    STATUS,
    VELOCITY,
)
from shared.wire import WireError

log = logging.getLogger(__name__)

PERIOD_S = 0.1
"""Longest sleep when nothing comes: requests and deaths are noticed this soon."""

HEARTBEAT_S = 1.0
"""Statuses are repeated this often: who was away, or lost a message, knows it this much later."""


class Planner:
    """Reads features and distances, answers each frame of a running mission with one heading."""

    def __init__(self, settings: PlannerSettings, bus: Bus) -> None:
        self._settings, self._bus = settings, bus
        self._profile: Profile = settings.rules()
        robot = settings.robot
        self._features_in = bus.subscribe(FEATURES, robot=robot)
        self._ranges_in = bus.subscribe(RANGES, robot=robot)
        self._velocities = bus.subscribe(VELOCITY, robot=robot)
        self._odometry = bus.subscribe(ODOMETRY, robot=robot)
        self._stops = bus.subscribe(ESTOP_STATE, robot=robot)
        self._wishes = bus.subscribe(MANUAL, robot=robot)
        self._planners = bus.subscribe(STATUS, robot=robot)
        self._requests = bus.requests(MISSION, robot=robot)
        self._kind_requests = bus.requests(MISSION_KINDS, robot=robot)
        self._headings = bus.publisher(HEADING, robot=robot)
        self._statuses = bus.publisher(STATUS, robot=robot)
        self._events = bus.publisher(EVENT, robot=robot)
        self._kinds = mission_kinds(settings.missions_folder)
        assigner = Assigner(settings, self._profile, self._kinds, bus, self._say_meanwhile)
        self.control = MissionControl(assigner, MissionRecords(settings, bus))
        self._replaced = False
        self._stopped: EStopState | None = None
        self._motion = FrameMotion()
        self._features: Features | None = None
        self._ranges: Ranges | None = None
        self._answered: Heading | None = None
        self._event_count = 0
        self._heartbeat_s = 0.0

    def step(self, now_s: float) -> None:
        """Requests first, then the newest frame; a planner that was replaced does neither."""
        if self._is_replaced():
            self._stand_by()
            return
        self._stopped = self._stops.take() or self._stopped
        while (request := self._requests.take()) is not None:
            self._handle(request)
        while (question := self._kind_requests.take()) is not None:
            question.reply(MissionKinds(kinds=self._kinds.infos()))
        by_hand = [wish.who for wish in self._wishes.take_all() if wish.action == "drive"]
        if self.control.state == "running":
            self._pause_where_held(by_hand[-1] if by_hand else "", now_s)
        for delta in self.control.changes():
            self.control.follow_store(delta)
        self._follow_robot(now_s)
        due = self._say_where_we_are(now_s)  # before what may be refused again and again
        self._features = self._features_in.take() or self._features
        if (
            self._features is not None
            and self._ranges is not None
            and self._ready(self._features, self._ranges)
        ):
            self._answer(self._motion.observe(self._features, now_s))
        if due:
            self.control.settle()

    def _pause_where_held(self, driver: str, now_s: float) -> None:
        """Pause for the emergency stop, or for a person who drives by hand, unless the mission goes along."""
        if stop := self._emergency_stop():
            self.control.pause(stop, "emergency_stop")
        elif driver and not self.control.goes_along:
            self.control.pause(f"{driver} drives by hand", "by_hand")
        else:
            return
        self._publish_status(now_s)

    def _follow_robot(self, now_s: float) -> None:
        """How the robot moves and what is around it."""
        for velocity in self._velocities.take_all():
            self._motion.told(velocity)
        for odometry in self._odometry.take_all():
            self._motion.measured(odometry)
        if (ranges := self._ranges_in.take()) is not None:
            self._ranges = ranges
            self._motion.sensed(ranges, now_s)

    def _is_replaced(self) -> bool:
        """Whether a planner with a later epoch speaks for this robot: then it alone decides, for good."""
        newest = max((status.epoch for status in self._planners.take_all()), default=0)
        if newest > self.control.epoch and not self._replaced:
            log.error(
                "alarm: another planner drives this robot: epoch %d, this one has %d and stands by",
                newest,
                self.control.epoch,
            )
            self._replaced = True
        return self._replaced

    def _stand_by(self) -> None:
        """Leave every question to the other planner, and the robot too."""
        while (request := self._requests.take()) is not None:
            request.leave()
        while (question := self._kind_requests.take()) is not None:
            question.leave()
        self.control.changes()

    def _ready(self, features: Features, ranges: Ranges) -> bool:
        """In lockstep both must be of one frame; the simulator repeats them until they are answered.

        A hand on the robot answers them at once: then distances are ahead, and the nearest in time are taken.
        """
        ahead = self.control.goes_along and features.seq < ranges.seq
        return not features.lockstep or features.seq == ranges.seq or ahead

    def _answer(self, observation: Observation) -> None:
        features = observation.features
        answered = self._answered
        if answered is not None and (answered.seq, answered.stamp_ns) == (features.seq, features.stamp_ns):
            self._headings.put(answered)
            self._features = None
            return
        if self.control.state != "running":
            return
        decision = self.control.step(observation)
        self._answered = self._heading(features, decision)
        self._headings.put(self._answered)
        self._features = None
        self._tell(features, decision)
        self._publish_status(time.monotonic())

    def _heading(self, features: Features, decision: Decision) -> Heading:
        return Heading(
            seq=features.seq,
            stamp_ns=features.stamp_ns,
            robot=self._settings.robot,
            mission_id=self.control.status().mission_id,
            epoch=self.control.epoch,
            ttl_ms=self._settings.heading_ttl_ms,
            action=decision.action,
            heading_rad=decision.heading_rad,
            face_rad=decision.face_rad,
            s_cv=decision.s_cv,
            s_slow=self._profile.travel.s_slow,
            s_max=self._profile.travel.s_max,
            speed_fraction=decision.speed_fraction,
            distance_m=decision.distance_m,
            method=decision.method,
            why=decision.why[:400],
        )

    def _tell(self, features: Features, decision: Decision) -> None:
        """Publish every decision with its reason."""
        self._event(
            features,
            "heading" if decision.action == "go" else "hold",
            decision.why,
            {
                "heading_rad": decision.heading_rad,
                "method": decision.method,
                "s_cv": decision.s_cv,
                "via_index": self.control.status().via_index,
                **self.control.step_costs_ms,
            },
        )
        for note in decision.notes:
            self._event(features, note.kind, note.reason, note.values)
        if decision.outcome:
            self._event(features, decision.outcome, decision.why, {"failure": decision.failure})

    def _event(
        self, features: Features, kind: str, reason: str, values: dict[str, float | int | str | bool | None]
    ) -> None:
        self._event_count += 1
        self._events.put(
            Event(
                seq=self._event_count,
                stamp_ns=features.stamp_ns,
                robot=self._settings.robot,
                mission_id=self.control.status().mission_id,
                step=self.control.step_count,
                kind=kind,
                reason=reason[:400],
                values=tuple(EventValue(name=name, value=value) for name, value in values.items()),
            )
        )

    def _emergency_stop(self) -> str:
        """Why the emergency stop holds the robot; "" when none does."""
        stopped = self._stopped
        if stopped is None or not stopped.engaged:
            return ""
        return f"emergency stop: {stopped.why}".rstrip(": ")

    def _handle(self, request: Request[MissionRequest, MissionStatus]) -> None:
        if request.message.action == "resume" and (stop := self._emergency_stop()):
            request.refuse(f"{stop} holds the robot: clear it first, then resume", "conflict")
            return
        try:
            status = self.control.handle(request.message)
        except (MissionError, QueryError, WireError) as error:
            code = error.code if isinstance(error, RefusedError | MissionError) else ""
            request.refuse(str(error), code)
            return
        request.reply(status)
        self._statuses.put(status)

    def _say_meanwhile(self) -> None:
        self._say_where_we_are(time.monotonic())

    def _say_where_we_are(self, now_s: float) -> bool:
        """To whoever listens, and in traffic; whether a status was due."""
        self.control.stand_in_traffic()
        if due := now_s - self._heartbeat_s > HEARTBEAT_S:
            self._publish_status(now_s)
        return due

    def _publish_status(self, now_s: float) -> None:
        self._heartbeat_s = now_s
        self._statuses.put(self.control.status())


def run(settings: PlannerSettings, bus: Bus, stop: threading.Event) -> None:
    """Claim the robot, then serve until `stop`; a service that is away is waited for."""
    planner = Planner(settings, bus)
    claimed = False
    while not stop.is_set():
        bus.wait(PERIOD_S)
        try:
            if not claimed:
                planner.control.claim()
                claimed = True
                bus.announce("planner")
            planner.step(time.monotonic())
        except (QueryError, WireError) as error:
            bus.counters.count("unanswered", str(error))
