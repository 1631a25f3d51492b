"""topnav's missions for ROS: services and topics as an action has them, of standard types only.

An action type of our own would have to be built and sourced on every machine. So a goal is a text of JSON:

| name (below /topnav) | type | |
|---|---|---|
| goal | topic std_msgs/String, in | what to do: {"action": "explore", "map": "flat", "parameters": {}} |
| goal_picture | topic sensor_msgs/CompressedImage, in | where to go, for goals that take a picture |
| start | std_srvs/Trigger | take up the goal; answers with the mission's id, or why not |
| pause, resume, cancel | std_srvs/Trigger | of the mission that runs |
| stop | std_srvs/Trigger | emergency stop; a person clears it (`topnav estop --clear`) |
| feedback, result | topics std_msgs/String, out | the mission's status as JSON, meanwhile and at its end |
"""

import json
import logging
import queue
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from pydantic import ValidationError

from services.ros.conversions.header import ConversionError
from services.ros.conversions.picture import panorama_of
from services.ros.wires.codec import Codec, CodecError
from services.ros.wires.wire import REPORT, Reply, Wire
from shared.bus import Bus
from shared.messages.base import Message
from shared.messages.estop import EStopRequest
from shared.messages.features import ExtractRequest, Features
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.sensors import Frame
from shared.queries import QueryError
from shared.topics import ESTOP, EXTRACT, MISSION
from shared.wire import WireError as BusError

log = logging.getLogger(__name__)

STRING, PICTURE = "std_msgs/msg/String", "sensor_msgs/msg/CompressedImage"
TRIGGER = "std_srvs/srv/Trigger"
CONTROLS = ("pause", "resume", "cancel")
WHO = "ros"
MOST_GOAL_BYTES = 64_000
"""Chosen: a goal is a few parameters."""
ASK_S, EXTRACT_S = 5.0, 20.0
"""Longest wait for planner and drive, and for the features of a picture; as of the shell and the gateway."""
FEEDBACK_S = 0.5
"""Between two reports of a mission that runs; chosen."""
ENDED = ("succeeded", "failed", "cancelled")


class MissionDesk:
    """Takes wishes on the wire's threads and asks for them in one of its own: answers take seconds."""

    def __init__(self, bus: Bus, codec: Codec, robot: str, stand: Callable[[], None]) -> None:
        self._bus, self._codec, self._robot, self._stand = bus, codec, robot, stand
        self._goal, self._picture = "", b""
        self._told_id, self._told_s = "", 0.0
        self._work: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="missions", daemon=True)
        self._thread.start()

    def open(self, wire: Wire, root: str) -> None:
        """Declare all services and topics below `root`."""
        wire.subscribe(f"{root}/goal", STRING, self._keep_goal, REPORT)
        wire.subscribe(f"{root}/goal_picture", PICTURE, self._keep_picture, REPORT)
        for name in ("start", *CONTROLS, "stop"):
            wire.serve(f"{root}/{name}", TRIGGER, partial(self._asked, name))
        self._feedback = wire.publisher(f"{root}/feedback", STRING)
        self._result = wire.publisher(f"{root}/result", STRING)

    def tell(self, status: MissionStatus, now_s: float) -> None:
        """Report a status: all ends, and what runs now and then."""
        if not status.mission_id:
            return
        if status.state in ENDED:
            if status.mission_id != self._told_id:
                self._told_id = status.mission_id
                self._result(self._text(status))
        elif now_s - self._told_s >= FEEDBACK_S:
            self._told_s = now_s
            self._feedback(self._text(status))

    def close(self) -> None:
        """End the thread; what waits is answered by nobody."""
        self._work.put(None)
        self._thread.join()

    def _run(self) -> None:
        while (task := self._work.get()) is not None:
            task()

    def _keep_goal(self, payload: bytes, _came_s: float) -> None:
        self._goal = ""
        if len(payload) > MOST_GOAL_BYTES:
            log.warning("goal: at most %d bytes expected, got %d", MOST_GOAL_BYTES, len(payload))
            return
        try:
            self._goal = self._codec.decode(STRING, payload).data
        except CodecError as error:
            log.warning("goal: %s", error)

    def _keep_picture(self, payload: bytes, _came_s: float) -> None:
        self._picture = payload

    def _asked(self, name: str, _request: bytes, reply: Reply) -> None:
        if name == "stop":
            self._stand()  # at once, whatever else is being asked
        self._work.put(partial(self._answer, name, reply))

    def _answer(self, name: str, reply: Reply) -> None:
        try:
            told = self._start() if name == "start" else self._control(name)
            success = True
        except (QueryError, BusError, CodecError, ConversionError, ValueError) as error:
            told, success = f"{name}: {error}", False
        response = self._codec.make(f"{TRIGGER}_Response", success=success, message=told[:400])
        reply(self._codec.encode(f"{TRIGGER}_Response", response))

    def _control(self, name: str) -> str:
        if name == "stop":
            self._bus.ask(
                ESTOP,
                EStopRequest(action="engage", who=WHO, why="asked for in ROS"),
                ASK_S,
                robot=self._robot,
            )
            return "the robot stands until a person clears it: topnav estop --clear --who NAME"
        return _said(self._bus.ask(MISSION, MissionRequest(action=name), ASK_S, robot=self._robot))

    def _start(self) -> str:
        wished = self._wished()
        picture = None
        if self._picture:
            picture, self._picture = self._features(self._picture), b""
        request = MissionRequest.model_validate({**wished, "goal": picture})
        self._goal = ""
        return _said(self._bus.ask(MISSION, request, ASK_S, robot=self._robot))

    def _wished(self) -> dict[str, Any]:
        if not self._goal:
            raise ValueError('no goal: publish one first, as {"action": "explore", "map": "flat"}')
        try:
            wished = json.loads(self._goal)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"the goal is not JSON: {str(error)[:100]}") from error
        allowed = set(MissionRequest.model_fields) - {"goal", "seq", "stamp_ns"}
        if not isinstance(wished, dict) or not wished.keys() <= allowed:
            raise ValueError(f"a goal is a JSON object with some of {', '.join(sorted(allowed))}")
        try:
            MissionRequest.model_validate(wished)
        except ValidationError as error:
            problem = error.errors(include_url=False)[0]
            raise ValueError(f"goal: {'.'.join(map(str, problem['loc']))}: {problem['msg']}") from error
        return wished

    def _features(self, payload: bytes) -> Features:
        panorama = panorama_of(self._codec.decode(PICTURE, payload), PICTURE, 0.5)
        frame = Frame(
            robot=self._robot, encoding=panorama.encoding, width_px=panorama.width_px,
            height_px=panorama.height_px, data=panorama.data,
        )  # fmt: skip
        return self._bus.ask(EXTRACT, ExtractRequest(frame=frame), EXTRACT_S)

    def _text(self, status: Message) -> bytes:
        return self._codec.encode(STRING, self._codec.make(STRING, data=status.model_dump_json()))


def _said(status: MissionStatus) -> str:
    return f"{status.mission_id or 'no mission'}: {status.action} {status.state} {status.reason}".strip()
