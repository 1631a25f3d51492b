"""What the gateway knows of every robot now and who wants to hear of it. Lives in the asyncio thread."""

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from services.gateway.http.metrics import Metrics
from services.gateway.live.outbox import Outbox
from services.gateway.live.true_poses import TruePoses
from shared.messages.base import Message
from shared.messages.body import Battery, Imu, Odometry
from shared.messages.camera import CameraState
from shared.messages.drive import Heading, Velocity
from shared.messages.estop import EStopState
from shared.messages.missions import Event, MissionStatus
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Truth
from shared.messages.tasks import QueueStatus
from shared.transport.keys import ANY

EVENTS_KEPT = 200
"""As many as the console's timeline shows at once."""


def facts_of(message: Message) -> dict[str, Any]:
    """A message as pages want it: a frame without its pixels, the time of an emergency stop as text."""
    if isinstance(message, Frame):
        return message.model_dump(include={"seq", "stamp_ns", "width_px", "height_px", "lockstep"})
    if isinstance(message, EStopState):
        since = datetime.fromtimestamp(message.since_ns / 1e9, UTC).isoformat(timespec="milliseconds")
        facts = message.model_dump(include={"robot", "engaged", "who", "why"})
        return facts | {"since": since if message.since_ns else None}  # there never was a change
    return message.model_dump(mode="json")


NEWEST: dict[type[Message], str] = {
    MissionStatus: "status",
    Heading: "heading",
    Ranges: "ranges",
    Velocity: "velocity",
    EStopState: "estop",
    Frame: "frame",
    QueueStatus: "queue",
}
"""What is kept and told as it stands now: the field of `RobotView`, and its name towards pages."""
BODY: dict[type[Message], str] = {
    Odometry: "odometry",
    Imu: "imu",
    Battery: "battery",
    CameraState: "camera",
}
"""The same of what a robot may say of its body."""
BODY_PERIOD_S = 0.5
"""No page reads these faster; an IMU speaks a hundred times a second."""


@dataclass
class RobotView:
    """The newest of everything one robot's services said; times are monotonic seconds."""

    seen_s: float = 0.0
    frame: Frame | None = None
    frame_s: float = 0.0
    ranges: Ranges | None = None
    heading: Heading | None = None
    velocity: Velocity | None = None
    estop: EStopState | None = None
    odometry: Odometry | None = None
    imu: Imu | None = None
    battery: Battery | None = None
    camera: CameraState | None = None
    queue: QueueStatus | None = None
    told_s: dict[str, float] = field(default_factory=dict)
    status: MissionStatus | None = None
    truth: Truth | None = None
    true_poses: TruePoses = field(default_factory=TruePoses)
    events: deque[Event] = field(default_factory=lambda: deque(maxlen=EVENTS_KEPT))
    changed: asyncio.Event = field(default_factory=asyncio.Event)
    outboxes: set[Outbox] = field(default_factory=set)


class Hub:
    """Keeps one `RobotView` per robot and passes news on to WebSockets and waiting requests.

    Args:
        metrics: what to count in.
        max_robots: further names are ignored.
        on_status: hears every status of a mission.

    Attributes:
        fleet: what was last said of the fleet's queue.
    """

    def __init__(
        self, metrics: Metrics, max_robots: int, on_status: Callable[[MissionStatus], None] = lambda _: None
    ) -> None:
        self._metrics, self._max_robots, self._on_status = metrics, max_robots, on_status
        self.robots: dict[str, RobotView] = {}
        self.services: dict[str, int] = {}
        self.fleet: QueueStatus | None = None

    def take(self, messages: Iterable[Message]) -> None:
        """Store what the bus brought, in the order it came."""
        for message in messages:
            robot = str(getattr(message, "robot", ""))
            if isinstance(message, QueueStatus) and robot == ANY:
                self.fleet = message
                continue
            if not self._has_room(robot):
                self._metrics.robots_ignored.inc()
                continue
            view = self.robots.setdefault(robot, RobotView())
            view.seen_s = time.monotonic()
            self._store(robot, view, message)

    def take_services(self, services: dict[str, int]) -> None:
        """Store how many processes of each service are alive."""
        self.services = services
        self.beat()

    def beat(self) -> None:
        """Tell every WebSocket which services live; also the sign that the gateway itself does."""
        text = _text("services", self.services)
        for view in self.robots.values():
            for outbox in view.outboxes:
                outbox.offer_newest("services", text)

    def knows(self, robot: str) -> bool:
        """Whether a robot of this name was ever heard of."""
        view = self.robots.get(robot)
        return view is not None and view.seen_s > 0.0

    def join(self, robot: str) -> Outbox | None:
        """Follow a robot: first what is known, then the news. None when there are too many robots."""
        if not self._has_room(robot):
            return None
        view = self.robots.setdefault(robot, RobotView())
        outbox = Outbox()
        outbox.offer_newest("services", _text("services", self.services))
        for kind in (*NEWEST.values(), *BODY.values()):
            if (message := getattr(view, kind)) is not None:
                outbox.offer_newest(kind, _text(kind, facts_of(message)))
        for event in view.events:
            outbox.offer(_text("event", facts_of(event)))
        view.outboxes.add(outbox)
        return outbox

    def leave(self, robot: str, outbox: Outbox) -> None:
        """Stop following. A name that only followers ever said takes no robot's place."""
        view = self.robots[robot]
        view.outboxes.discard(outbox)
        if not view.outboxes and not self.knows(robot):
            del self.robots[robot]

    def _has_room(self, robot: str) -> bool:
        return self.knows(robot) or sum(map(self.knows, self.robots)) < self._max_robots

    def _store(self, robot: str, view: RobotView, message: Message) -> None:
        if (kind := NEWEST.get(type(message))) is not None:
            setattr(view, kind, message)
            _tell(view, kind, message)
        elif (kind := BODY.get(type(message))) is not None:
            setattr(view, kind, message)
            if view.seen_s - view.told_s.get(kind, 0.0) >= BODY_PERIOD_S:
                view.told_s[kind] = view.seen_s
                _tell(view, kind, message)
        match message:
            case Frame():
                view.frame_s = view.seen_s
                self._metrics.frames.labels(robot).inc()
            case MissionStatus():
                view.changed.set()
                view.changed = asyncio.Event()
                self._on_status(message)
            case Event():
                view.events.append(message)
                text = _text("event", facts_of(message))
                for outbox in view.outboxes:
                    outbox.offer(text)
            case Truth():
                view.truth = message
                view.true_poses.take(message)


def _tell(view: RobotView, kind: str, message: Message) -> None:
    """Pass on how something stands now to whoever follows."""
    if view.outboxes:
        text = _text(kind, facts_of(message))
        for outbox in view.outboxes:
            outbox.offer_newest(kind, text)


def _text(kind: str, data: dict[str, Any]) -> str:
    return json.dumps({"type": kind, "data": data}, separators=(",", ":"))
