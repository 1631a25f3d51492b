"""Every key expression beside its message type and delivery policy."""

from dataclasses import dataclass
from enum import Enum
from typing import Any, Generic, TypeVar

from shared.messages import (
    body,
    camera,
    drive,
    estop,
    features,
    inspections,
    maps,
    matching,
    missions,
    sensors,
    simulation,
    tasks,
    traffic,
)
from shared.messages.base import Message
from shared.transport.keys import fill

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

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
        lapses: it changes nothing, so that answering it once its asker has given up is work for nobody: such
            questions are dropped. Others are dealt with however late: a stop, above all.
    """

    template: str
    request: type[Q]
    reply: type[R]
    max_bytes: int
    anyone: bool = False
    lapses: bool = False

    def key(self, **names: str) -> str:
        """Fill the template; a name that breaks the rule raises ValueError."""
        return fill(self.template, names)


FRAME = Topic("topnav/{robot}/frame", sensors.Frame, Delivery.DATA, 64 * MB)
CAMERA_STATE = Topic("topnav/{robot}/camera", camera.CameraState, Delivery.DATA, 10_000)
RANGES = Topic("topnav/{robot}/ranges", sensors.Ranges, Delivery.DATA, 10_000)
FEATURES = Topic("topnav/{robot}/features", features.Features, Delivery.DATA, 8 * MB)
HEADING = Topic("topnav/{robot}/heading", drive.Heading, Delivery.COMMAND, 10_000)
VELOCITY = Topic("topnav/{robot}/velocity", drive.Velocity, Delivery.COMMAND, 10_000)
MANUAL = Topic("topnav/{robot}/manual", drive.Manual, Delivery.COMMAND, 10_000)
ODOMETRY = Topic("topnav/{robot}/odometry", body.Odometry, Delivery.LOG, 10_000)
IMU = Topic("topnav/{robot}/imu", body.Imu, Delivery.DATA, 10_000)
BATTERY = Topic("topnav/{robot}/battery", body.Battery, Delivery.DATA, 10_000)
ESTOP_STATE = Topic("topnav/{robot}/stopped", estop.EStopState, Delivery.COMMAND, 10_000)
ROBOT_ESTOP_STATE = Topic("topnav/{robot}/standing", estop.EStopState, Delivery.COMMAND, 10_000)
STATUS = Topic("topnav/{robot}/status", missions.MissionStatus, Delivery.LOG, 1 * MB)
QUEUE = Topic("topnav/{robot}/queue", tasks.QueueStatus, Delivery.DATA, 10_000)
FLEET_QUEUE = Topic("topnav/any/fleet", tasks.QueueStatus, Delivery.DATA, 10_000)
EVENT = Topic("topnav/{robot}/event", missions.Event, Delivery.LOG, 100_000)
TRUTH = Topic("topnav/{robot}/truth", simulation.Truth, Delivery.LOG, 10_000)
MAP_DELTA = Topic("topnav/maps/{map}/delta", maps.MapDelta, Delivery.RECOVERED, 64 * MB)

MATCH = Query(
    "topnav/{robot}/match", matching.MatchRequest, matching.MatchReply, 32 * MB, anyone=True, lapses=True
)
EXTRACT = Query(
    "topnav/features/extract",
    features.ExtractRequest,
    features.Features,
    64 * MB,
    anyone=True,
    lapses=True,
)
EXTRACT_PHOTO = Query(
    "topnav/features/extract_photo",
    features.ExtractPhotoRequest,
    features.Features,
    64 * MB,
    anyone=True,
    lapses=True,
)
MISSION = Query("topnav/{robot}/mission", missions.MissionRequest, missions.MissionStatus, 8 * MB)
MISSION_KINDS = Query(
    "topnav/{robot}/mission/kinds", missions.MissionKindsRequest, missions.MissionKinds, 1 * MB
)
ESTOP = Query("topnav/{robot}/estop", estop.EStopRequest, estop.EStopState, 10_000)
MAP = Query("topnav/maps/{map}/graph", maps.MapRequest, maps.MapReply, 512 * MB, anyone=True)
MAP_READ = Query("topnav/maps/{map}/read", maps.MapRequest, maps.MapReply, 512 * MB, anyone=True)
MISSION_RECORD = Query(
    "topnav/missions/{robot}", maps.MissionRecordRequest, maps.MissionRecord, 8 * MB, anyone=True
)
TASKS = Query("topnav/missions/{queue}/tasks", tasks.TaskRequest, tasks.TaskReply, 8 * MB, anyone=True)
WAY = Query("topnav/{robot}/way", traffic.WayRequest, traffic.WayReply, 1 * MB)
COMPARE = Query(
    "topnav/{robot}/compare",
    inspections.CompareRequest,
    inspections.CompareReply,
    8 * MB,
    anyone=True,
    lapses=True,
)
INSPECTION = Query(
    "topnav/maps/{map}/inspections",
    inspections.InspectionRequest,
    inspections.InspectionReply,
    8 * MB,
    anyone=True,
)
SIMULATION = Query(
    "topnav/{robot}/simulation", simulation.SimulationRequest, simulation.SimulationReply, 64 * MB
)

TOPICS: tuple[Topic[Any], ...] = tuple(
    entry for entry in list(globals().values()) if isinstance(entry, Topic)
)
QUERIES: tuple[Query[Any, Any], ...] = tuple(
    entry for entry in list(globals().values()) if isinstance(entry, Query)
)
