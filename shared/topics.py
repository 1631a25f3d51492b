"""Every key expression beside its message type and delivery policy."""

import re
from dataclasses import dataclass
from enum import Enum
from typing import Generic, TypeVar

from shared.messages import (
    Command,
    EStopRequest,
    EStopState,
    Event,
    ExtractRequest,
    Features,
    Frame,
    Heading,
    MapDelta,
    MapReply,
    MapRequest,
    MatchReply,
    MatchRequest,
    Message,
    MissionKinds,
    MissionKindsRequest,
    MissionRecord,
    MissionRecordRequest,
    MissionRequest,
    MissionStatus,
    Ranges,
    SimulationReply,
    SimulationRequest,
    Truth,
)

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

NAME = re.compile(r"[a-z0-9_-]{1,64}\Z")
MB = 1_000_000


class Delivery(Enum):
    """What a slow reader means for the others."""

    DATA = "newest only, dropped under load"
    COMMAND = "newest only, real-time priority, sent at once"
    LOG = "queue of 1024, oldest dropped and counted"
    RECOVERED = "ordered queue, lost samples fetched again from the publisher's cache"


@dataclass(frozen=True)
class Topic(Generic[M]):
    """One stream: key template, message type, delivery, longest payload."""

    template: str
    message: type[M]
    delivery: Delivery
    max_bytes: int

    def key(self, **names: str) -> str:
        """Fill the template; a name that breaks the rule raises ValueError ('*' is for subscribers)."""
        return fill(self.template, names)


@dataclass(frozen=True)
class Query(Generic[Q, R]):
    """One question and its answer.

    Attributes:
        anyone: of several processes that answer this, any one will do, and only one is asked; otherwise all
            are, and the first answer counts.
    """

    template: str
    request: type[Q]
    reply: type[R]
    max_bytes: int
    anyone: bool = False

    def key(self, **names: str) -> str:
        """Fill the template; a name that breaks the rule raises ValueError."""
        return fill(self.template, names)


def fill(template: str, names: dict[str, str]) -> str:
    """Put checked names into a key template."""
    for label, name in names.items():
        if name != "*" and not NAME.match(name):
            raise ValueError(f"{label} must match [a-z0-9_-]{{1,64}}, got {name[:80]!r}")
    return template.format(**names)


FRAME = Topic("topnav/{robot}/frame", Frame, Delivery.DATA, 64 * MB)
RANGES = Topic("topnav/{robot}/ranges", Ranges, Delivery.DATA, 10_000)
FEATURES = Topic("topnav/{robot}/features", Features, Delivery.DATA, 8 * MB)
HEADING = Topic("topnav/{robot}/heading", Heading, Delivery.COMMAND, 10_000)
COMMAND = Topic("topnav/{robot}/command", Command, Delivery.COMMAND, 10_000)
ESTOP_STATE = Topic("topnav/{robot}/stopped", EStopState, Delivery.COMMAND, 10_000)
ROBOT_ESTOP_STATE = Topic("topnav/{robot}/standing", EStopState, Delivery.COMMAND, 10_000)
STATUS = Topic("topnav/{robot}/status", MissionStatus, Delivery.LOG, 1 * MB)
EVENT = Topic("topnav/{robot}/event", Event, Delivery.LOG, 100_000)
TRUTH = Topic("topnav/{robot}/truth", Truth, Delivery.LOG, 10_000)
MAP_DELTA = Topic("topnav/maps/{map}/delta", MapDelta, Delivery.RECOVERED, 64 * MB)

MATCH = Query("topnav/{robot}/match", MatchRequest, MatchReply, 32 * MB, anyone=True)
EXTRACT = Query("topnav/features/extract", ExtractRequest, Features, 64 * MB, anyone=True)
MISSION = Query("topnav/{robot}/mission", MissionRequest, MissionStatus, 8 * MB)
MISSION_KINDS = Query("topnav/{robot}/mission/kinds", MissionKindsRequest, MissionKinds, 1 * MB)
ESTOP = Query("topnav/{robot}/estop", EStopRequest, EStopState, 10_000)
MAP = Query("topnav/maps/{map}/graph", MapRequest, MapReply, 512 * MB, anyone=True)
MAP_READ = Query("topnav/maps/{map}/read", MapRequest, MapReply, 512 * MB, anyone=True)
MISSION_RECORD = Query("topnav/missions/{robot}", MissionRecordRequest, MissionRecord, 8 * MB, anyone=True)
SIMULATION = Query("topnav/{robot}/simulation", SimulationRequest, SimulationReply, 64 * MB)

TOPICS: tuple[Topic[Message], ...] = (
    FRAME,
    RANGES,
    FEATURES,
    HEADING,
    COMMAND,
    ESTOP_STATE,
    ROBOT_ESTOP_STATE,
    STATUS,
    EVENT,
    TRUTH,
    MAP_DELTA,
)  # type: ignore[assignment]
QUERIES: tuple[Query[Message, Message], ...] = (
    MATCH,
    EXTRACT,
    MISSION,
    MISSION_KINDS,
    ESTOP,
    MAP,
    MAP_READ,
    MISSION_RECORD,
    SIMULATION,
)  # type: ignore[assignment]


def alive_key(service: str, instance: str) -> str:
    """Liveliness key of one process; '*' as instance watches them all."""
    return fill("topnav/alive/{service}/{instance}", {"service": service, "instance": instance})


def robot_key(robot: str, holder: str) -> str:
    """Liveliness key of a process that is robot `robot`; '*' as holder watches for all that say so."""
    return fill("topnav/alive/robot/{robot}/{holder}", {"robot": robot, "holder": holder})
