"""What a mission sees of the world and what it decides; the service fills these from the bus."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, Protocol

from services.planner.graph import MapGraph
from shared.messages.features import Features
from shared.messages.maps import Operation
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind
from shared.messages.sensors import Ranges

GOAL = -1
"""Node id under which the goal picture is reported by a match."""


@dataclass(frozen=True)
class Observation:
    """One frame: what it looks like and the distances around."""

    features: Features
    ranges: Ranges


class Matcher(Protocol):
    """Compares the current frame with places."""

    def match(
        self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()
    ) -> dict[int, NodeMatch]:
        """Matches of the current frame by node id, most similar first."""

    def locate(self, features: Features, best_k: int) -> dict[int, NodeMatch]:
        """Matches of any picture with the most similar nodes of the map."""


class MapAccess(Protocol):
    """The map as the planner knows it, and the way to change it."""

    graph: MapGraph

    def commit(self, operations: Sequence[Operation]) -> None:
        """Write all operations or none; the graph shows them afterwards."""


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
    """Where a mission stands, for its status."""

    via_points: tuple[int, ...] = ()
    via_index: int = 0
    nearest_node: int | None = None
    similarity: int = 0
    disparity_rad: float | None = None


class Mission(Protocol):
    """Explore or goto: decides once per frame."""

    progress: Progress

    def decide(self, observation: Observation) -> Decision:
        """Choose what to do after this frame."""
