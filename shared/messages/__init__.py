"""Messages, one file per link. The bus contract; JSON Schemas are generated into deploy/contracts."""

from shared.messages.base import Message
from shared.messages.drive import Command, Heading
from shared.messages.estop import EStopRequest, EStopState
from shared.messages.features import ExtractRequest, Features
from shared.messages.maps import MapDelta, MapReply, MapRequest, MissionRecord, MissionRecordRequest
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.missions import Event, MissionKinds, MissionKindsRequest, MissionRequest, MissionStatus
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import SimulationReply, SimulationRequest, Truth

ALL: tuple[type[Message], ...] = (
    Frame,
    Ranges,
    Features,
    ExtractRequest,
    MatchRequest,
    MatchReply,
    Heading,
    Command,
    EStopRequest,
    EStopState,
    MissionRequest,
    MissionStatus,
    MissionKindsRequest,
    MissionKinds,
    Event,
    MapRequest,
    MapReply,
    MapDelta,
    MissionRecord,
    MissionRecordRequest,
    Truth,
    SimulationRequest,
    SimulationReply,
)
"""Every message kind that may appear on the bus."""

__all__ = [
    "ALL",
    "Command",
    "EStopRequest",
    "EStopState",
    "Event",
    "ExtractRequest",
    "Features",
    "Frame",
    "Heading",
    "MapDelta",
    "MapReply",
    "MapRequest",
    "MatchReply",
    "MatchRequest",
    "Message",
    "MissionKinds",
    "MissionKindsRequest",
    "MissionRecord",
    "MissionRecordRequest",
    "MissionRequest",
    "MissionStatus",
    "Ranges",
    "SimulationReply",
    "SimulationRequest",
    "Truth",
]
