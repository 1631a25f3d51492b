"""What a mission sees of the world and what it decides; the service fills these from the bus."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, Protocol

from shared.mapgraph.graph import MapGraph
from shared.messages.features import Features
from shared.messages.maps import Operation
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges

Matches = dict[int, NodeMatch]
"""How a picture relates to nodes, by node id; to a goal picture by routing.GOAL."""


@dataclass(frozen=True)
class Observation:
    """One frame: what it looks like, the distances around, and what the robot did since the one before.

    Attributes:
        moved_m: displacement since then by its own commands or odometry, robot frame.
    """

    features: Features
    ranges: Ranges
    moved_m: tuple[float, float] = (0.0, 0.0)


class Matcher(Protocol):
    """Compares the current frame with nodes."""

    def match(self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()) -> Matches:
        """Matches of the current frame by node id, most similar first."""

    def locate(self, features: Features, best_k: int) -> Matches:
        """Matches of any picture with the most similar nodes of the map."""


class MapAccess(Protocol):
    """The map as the planner knows it, and the way to change it."""

    graph: MapGraph

    def commit(self, operations: Sequence[Operation]) -> None:
        """Write all operations or none; the graph shows them afterwards."""

    def features_of(self, node_id: int) -> Features:
        """What a node looks like."""


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
        heading_rad: where to go, robot frame; ignored for "hold".
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


@dataclass(frozen=True)
class Progress:
    """Where a mission stands, for its status.

    Attributes:
        travel: state of the travel machine, "" while the mission does not travel; travel_reason: of its last
            transition.
        figures: of this kind of mission, for its record.
    """

    via_points: tuple[int, ...] = ()
    via_index: int = 0
    nearest_node: int | None = None
    similarity: int = 0
    disparity_rad: float | None = None
    travel: str = ""
    travel_reason: str = ""
    figures: Mapping[str, float | int | str | bool | None] = field(default_factory=dict)


class Mission(Protocol):
    """Decides once per frame."""

    @property
    def progress(self) -> Progress:
        """Where it stands."""

    def decide(self, observation: Observation) -> Decision:
        """Choose what to do after this frame."""
