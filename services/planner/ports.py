"""What a mission sees of the world and what it decides; the service fills these from the bus."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

from pydantic import JsonValue

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.rules import Limits
from shared.messages.features import Features
from shared.messages.inspections import Inspection
from shared.messages.maps import Operation
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, Motion

SPOT_M_PER_RAD = 0.1
"""A robot that goes less than this for each radian that it turns, turns on the spot; chosen: a quarter of the
tightest circle that a base curves on."""
SPOT_SHARE = 0.25
"""What a frame of turning on the spot counts of one in which the robot gets on, where patience is counted in
frames; chosen: half a turn at 1.5 rad/s takes seven of them, less than the least patience in all."""

Matches = dict[int, NodeMatch]
"""How a picture relates to nodes, by node id; to a goal picture by routing.GOAL."""


@dataclass(frozen=True)
class Observation:
    """One frame: what it looks like, the distances around, and what the robot did since the one before.

    Attributes:
        ranges: of about the moment of the frame.
        moved: since the frame before, by the robot's odometry or commands.
        since: since this frame was taken, likewise: the picture is that old.
    """

    features: Features
    ranges: Ranges
    moved: Motion = NO_MOTION
    since: Motion = NO_MOTION

    @property
    def frame_share(self) -> float:
        """What this frame counts where patience is counted in frames: less when the robot only turned."""
        on_the_spot = self.moved.way_m < SPOT_M_PER_RAD * abs(self.moved.turn_rad)
        return SPOT_SHARE if on_the_spot else 1.0


class Matcher(Protocol):
    """Compares the current frame with nodes."""

    def match(self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()) -> Matches:
        """Matches of the current frame by node id, most similar first."""

    def locate(
        self, features: Features, best_k: int, node_ids: Sequence[int] = (), *, with_differences: bool = False
    ) -> Matches:
        """Matches of any picture with given nodes, and with the most similar ones of the map.

        With differences it also says by how much given nodes differ as pictures that are near.
        """


class Inspector(Protocol):
    """Looks at a place for what changed there."""

    def inspect(self, place: str, round_number: int, keep: int) -> Inspection:
        """Keep the current frame as the picture of a place, compared with the one before.

        Args:
            place: where the robot stands.
            round_number: of the mission, from 1.
            keep: pictures of the place that stay.
        """


@dataclass(frozen=True)
class RightOfWay:
    """How far the robot may go, where others drive too.

    Attributes:
        free: nodes of the way ahead that are its own.
        why: what the next one waits for.
        room: nodes of the way by which it is to make room for others first; empty where it need not.
    """

    free: int
    why: str = ""
    room: tuple[int, ...] = ()


class MapAccess(Protocol):
    """The map as the planner knows it, the way to change it, and who else drives in it."""

    graph: MapGraph

    @property
    def shared(self) -> bool:
        """Whether somebody has to be asked for the right of way."""

    def limits(self) -> Limits:
        """What the rules of the map say now."""

    def commit(self, operations: Sequence[Operation]) -> None:
        """Write all operations or none; the graph shows them afterwards."""

    def features_of(self, node_id: int) -> Features:
        """What a node looks like."""

    def right_of_way(self, at: Sequence[int], ahead: Sequence[int]) -> RightOfWay:
        """How far the robot may go.

        Args:
            at: nodes between which it is, the one that it heads for last; empty where nobody knows.
            ahead: nodes of its way beyond.
        """


@dataclass(frozen=True)
class Note:
    """A decision worth telling: becomes an event."""

    kind: str
    reason: str
    values: dict[str, float | int | str | bool | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Decision:
    """The outcome of one step.

    Attributes:
        heading_rad: where to go, robot frame of the observation; ignored for "hold".
        face_rad: with "hold", where the robot's front is to turn to, the same frame; None to stand still.
        distance_m: about how far what is headed for is; None where it is nothing in particular.
        outcome: "" while the mission goes on.
    """

    action: Literal["go", "hold"]
    heading_rad: float = 0.0
    s_cv: int = 0
    speed_fraction: float = 1.0
    method: str = ""
    why: str = ""
    notes: tuple[Note, ...] = ()
    outcome: Literal["", "succeeded", "failed"] = ""
    failure: FailureKind = ""
    distance_m: float | None = None
    face_rad: float | None = None


@dataclass(frozen=True)
class Progress:
    """Where a mission stands, for its status.

    Attributes:
        travel: state of the travel machine, "" while the mission does not travel; travel_reason: of its last
            transition.
        figures: of this kind of mission, for its record.
        checkpoint: what a planner that restarts needs to go on from here; kept whenever it changes.
    """

    via_points: tuple[int, ...] = ()
    via_index: int = 0
    nearest_node: int | None = None
    similarity: int = 0
    disparity_rad: float | None = None
    travel: str = ""
    travel_reason: str = ""
    figures: Mapping[str, float | int | str | bool | None] = field(default_factory=dict)
    checkpoint: Mapping[str, JsonValue] = field(default_factory=dict)


class Mission(Protocol):
    """Decides once per frame."""

    @property
    def progress(self) -> Progress:
        """Where it stands."""

    def decide(self, observation: Observation) -> Decision:
        """Choose what to do after this frame."""


@runtime_checkable
class Accompanying(Mission, Protocol):
    """A mission that goes along while a person drives, and ends when a person says so."""

    def finish(self) -> str:
        """Do what is left to do at the end; what was done, for people."""
