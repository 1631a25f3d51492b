"""One mission of one robot: started over the bus and followed to its end, with the true way beside it."""

import time
from dataclasses import dataclass

from services.launcher.client.failure import ExperimentError
from services.launcher.client.trail import Trail
from services.launcher.terminal.progress import Watch
from shared.bus import Bus
from shared.messages.features import ExtractRequest, Features
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.sensors import Frame
from shared.messages.simulation import Truth
from shared.queries import QueryError
from shared.topics import EXTRACT, FEATURES, HEADING, MISSION, STATUS, TRUTH

TERMINAL = frozenset({"succeeded", "failed", "cancelled"})
ASK_TIMEOUT_S = 10.0
"""A planner answers within a step, of which the slowest takes a second on a loaded machine."""

EXTRACT_TIMEOUT_S = 30.0
"""A learned extractor takes seconds for its first picture."""

SILENCE_S = 60.0
"""Longer than a service that died needs to be back and to take its mission up again."""

PERIOD_S = 0.2  # wakes at once when something comes; so often without


@dataclass(frozen=True)
class MissionRun:
    """How a mission went.

    Attributes:
        status: its last status.
        truths: true states from just before it to its end.
        last_seq: number of the last frame that was answered; the robot stands once the next one is out.
        via: all via points it ever planned, in the order of the plans.
    """

    status: MissionStatus
    truths: list[Truth]
    wall_s: float
    via: tuple[int, ...] = ()
    last_seq: int = 0

    @property
    def succeeded(self) -> bool:
        """Whether the planner says that it reached what was asked."""
        return self.status.state == "succeeded"

    @property
    def steps_per_s(self) -> float:
        """Frames answered per second of wall time."""
        return self.status.step / max(self.wall_s, 1e-9)


def goal_features(bus: Bus, picture: Frame) -> Features:
    """What the feature service sees in a goal picture, as a mission goto wants it."""
    return bus.ask(EXTRACT, ExtractRequest(frame=picture), EXTRACT_TIMEOUT_S)


class MissionClient:
    """Runs missions one after the other; `trail` collects all true states from its making on."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot = bus, robot
        self._statuses = bus.subscribe(STATUS, robot=robot)
        self._truths = bus.subscribe(TRUTH, robot=robot)
        self._features = bus.subscribe(FEATURES, robot=robot)
        self._headings = bus.subscribe(HEADING, robot=robot)
        self.trail = Trail()

    def ask(self, request: MissionRequest) -> MissionStatus:
        """Send one request to the planner."""
        return self._bus.ask(MISSION, request, ASK_TIMEOUT_S, robot=self._robot)

    def wait_for_frame(self, after_ns: int, timeout_s: float = 30.0) -> Features:
        """Wait for the features of a frame later than `after_ns`, so that no older one is answered.

        The trail has begun by then: the next node's true pose is known.
        """
        deadline_s = time.monotonic() + timeout_s
        while time.monotonic() < deadline_s:
            self._bus.wait(PERIOD_S)
            self.collect()
            features = self._features.take()
            if features is not None and features.stamp_ns > after_ns and self.trail.begun(features.stamp_ns):
                return features
        raise ExperimentError(f"no frame came through the feature service within {timeout_s:.0f} s")

    def run(self, request: MissionRequest, watch: Watch | None = None) -> MissionRun:
        """Start a mission and follow it to its end; an interrupt cancels it."""
        self.collect()
        return self.follow(self.ask(request), watch)

    def follow(self, started: MissionStatus, watch: Watch | None = None) -> MissionRun:
        """Follow a mission that somebody started just now."""
        mark, start_s = self.trail.mark(), time.monotonic()
        status, via = started, dict.fromkeys(started.via_points)
        try:
            while status.state not in TERMINAL:
                status = self._next(status)
                via |= dict.fromkeys(status.via_points)
                if watch is not None:
                    watch(status)
        except BaseException:
            self._cancel()
            raise
        wall_s = time.monotonic() - start_s
        self.collect()
        heading = self._headings.take()
        last_seq = heading.seq if heading is not None else 0
        return MissionRun(status, self.trail.since(mark), wall_s, tuple(via), last_seq)

    def collect(self) -> None:
        """Put the true states that came in into the trail."""
        self.trail.add(self._truths.take_all())

    def _next(self, last: MissionStatus) -> MissionStatus:
        """The newest status of the mission; statuses of others, perhaps still under way, are passed over."""
        deadline_s = time.monotonic() + SILENCE_S
        other = ""
        while time.monotonic() < deadline_s:
            self._bus.wait(PERIOD_S)
            self.collect()
            news = self._statuses.take_all()
            mine = [status for status in news if status.mission_id == last.mission_id]
            if mine and mine[-1].state == "idle":
                raise ExperimentError("the planner restarted and no longer knows how the mission ended")
            if mine:
                return mine[-1]
            other = news[-1].mission_id if news else other
        heard = f"it follows mission {other!r}" if other else "it is silent"
        raise ExperimentError(f"nothing about mission {last.mission_id!r} for {SILENCE_S:.0f} s: {heard}")

    def _cancel(self) -> None:
        try:
            self.ask(MissionRequest(action="cancel"))
        except QueryError:
            return
