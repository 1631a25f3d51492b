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
from shared.messages.drive import Command, Heading
from shared.messages.estop import EStopState
from shared.messages.missions import Event, MissionStatus
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Truth

EVENTS_KEPT = 200
STATES: dict[type[Message], str] = {Ranges: "ranges", Heading: "heading", Command: "command"}
"""What is kept and told as it is: the field of `RobotView`, and the name towards pages."""


@dataclass
class RobotView:
    """The newest of everything one robot's services said; times are monotonic seconds."""

    seen_s: float = 0.0
    frame: Frame | None = None
    frame_s: float = 0.0
    ranges: Ranges | None = None
    heading: Heading | None = None
    command: Command | None = None
    estop: EStopState | None = None
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
    """

    def __init__(
        self, metrics: Metrics, max_robots: int, on_status: Callable[[MissionStatus], None] | None = None
    ) -> None:
        self._metrics, self._max_robots, self._on_status = metrics, max_robots, on_status
        self.robots: dict[str, RobotView] = {}
        self.services: dict[str, int] = {}

    def take(self, messages: Iterable[Message]) -> None:
        """Store what the bus brought, in the order it came."""
        for message in messages:
            robot = str(getattr(message, "robot", ""))
            view = self.view(robot)
            if view is None:
                self._metrics.robots_ignored.inc()
                continue
            view.seen_s = time.monotonic()
            self._store(robot, view, message)

    def take_services(self, services: dict[str, int]) -> None:
        """Store how many processes of each service are alive."""
        self.services = services
        self.beat()

    def beat(self) -> None:
        """Tell every WebSocket which services live; also the sign that the gateway itself does."""
        text = json.dumps({"type": "services", "data": self.services})
        for view in self.robots.values():
            for outbox in view.outboxes:
                outbox.offer_newest("services", text)

    def view(self, robot: str) -> RobotView | None:
        """The robot's view, made on first sight; None when there are too many robots."""
        if robot not in self.robots and len(self.robots) < self._max_robots:
            self.robots[robot] = RobotView()
        return self.robots.get(robot)

    def join(self, robot: str) -> Outbox | None:
        """Follow a robot: first what is known, then the news. None when there are too many robots."""
        view = self.view(robot)
        if view is None:
            return None
        outbox = Outbox()
        outbox.offer_newest("services", json.dumps({"type": "services", "data": self.services}))
        known = {
            "status": view.status,
            "heading": view.heading,
            "ranges": view.ranges,
            "command": view.command,
        }
        for kind, message in known.items():
            if message is not None:
                outbox.offer_newest(kind, _text(kind, message.model_dump(mode="json")))
        if view.estop is not None:
            outbox.offer_newest("estop", _text("estop", estop_facts(view.estop)))
        if view.frame is not None:
            outbox.offer_newest("frame", _text("frame", frame_facts(view.frame)))
        for event in view.events:
            outbox.offer(_text("event", event.model_dump(mode="json")))
        view.outboxes.add(outbox)
        return outbox

    def leave(self, robot: str, outbox: Outbox) -> None:
        """Stop following."""
        if robot in self.robots:
            self.robots[robot].outboxes.discard(outbox)

    def _store(self, robot: str, view: RobotView, message: Message) -> None:
        if (kind := STATES.get(type(message))) is not None:
            setattr(view, kind, message)
            _tell(view, kind, message.model_dump(mode="json"))
            return
        match message:
            case Frame():
                view.frame, view.frame_s = message, view.seen_s
                self._metrics.frames.labels(robot).inc()
                _tell(view, "frame", frame_facts(message))
            case EStopState():
                view.estop = message
                _tell(view, "estop", estop_facts(message))
            case MissionStatus():
                view.status = message
                _tell(view, "status", message.model_dump(mode="json"))
                view.changed.set()
                view.changed = asyncio.Event()
                if self._on_status is not None:
                    self._on_status(message)
            case Event():
                view.events.append(message)
                text = _text("event", message.model_dump(mode="json"))
                for outbox in view.outboxes:
                    outbox.offer(text)
            case Truth():
                view.truth = message
                view.true_poses.take(message)
            case _:
                raise TypeError(f"message must be one the gateway follows, got {type(message).__name__}")


def frame_facts(frame: Frame) -> dict[str, Any]:
    """A frame without its pixels."""
    return {
        "seq": frame.seq,
        "stamp_ns": frame.stamp_ns,
        "width_px": frame.width_px,
        "height_px": frame.height_px,
        "lockstep": frame.lockstep,
    }


def estop_facts(state: EStopState) -> dict[str, Any]:
    """An emergency stop as pages want it: the time as text, null while there never was a change."""
    since = datetime.fromtimestamp(state.since_ns / 1e9, UTC).isoformat(timespec="milliseconds")
    return {
        "robot": state.robot,
        "engaged": state.engaged,
        "who": state.who,
        "why": state.why,
        "since": since if state.since_ns else None,
    }


def _tell(view: RobotView, kind: str, data: dict[str, Any]) -> None:
    if view.outboxes:
        text = _text(kind, data)
        for outbox in view.outboxes:
            outbox.offer_newest(kind, text)


def _text(kind: str, data: dict[str, Any]) -> str:
    return json.dumps({"type": kind, "data": data}, separators=(",", ":"))
