"""What REST takes and gives."""

from collections.abc import Sequence

from pydantic import BaseModel, ConfigDict

from services.map_store.integrity.check import Damage
from services.map_store.storage.catalogue import MapRecord
from shared.messages.base import Name
from shared.messages.features import Features
from shared.messages.maps import Edge, Node


class MapView(BaseModel):
    """One map."""

    model_config = ConfigDict(from_attributes=True)

    name: Name
    revision: int
    nodes: int
    edges: int
    created_ns: int
    changed_ns: int


class MapCreate(BaseModel):
    """A map to make."""

    model_config = ConfigDict(extra="forbid")

    name: Name


class MapRename(BaseModel):
    """A new name."""

    model_config = ConfigDict(extra="forbid")

    name: Name


class NodeView(Node):
    """A node as stored.

    Attributes:
        revision: the revision that wrote it last.
        thumbnail: whether it has a picture.
        quarantined: its features are damaged, as somebody who asked for them found; it cannot be recognised.
    """

    revision: int
    thumbnail: bool
    quarantined: bool


class EdgeView(Edge):
    """An edge with its evidence and the revision that wrote it last."""

    revision: int


class KeypointsView(BaseModel):
    """The keypoints of a node in the order of its features.

    Attributes:
        lonlat_rad: longitude and latitude of each, radians, the node's camera frame.
        scores: detector response of each, larger is better.
    """

    lonlat_rad: list[tuple[float, float]]
    scores: list[float]


class Changed(BaseModel):
    """The revision a write led to."""

    map: Name
    revision: int


class Undone(Changed):
    """The revision an undo led to and the one it took back."""

    undone: int


class DamageView(BaseModel):
    """One damaged thing.

    Attributes:
        map: the map it belongs to; "" for what all maps share.
    """

    model_config = ConfigDict(from_attributes=True)

    map: str
    thing: str
    reason: str


class CheckView(BaseModel):
    """Everything that is damaged."""

    damage: list[DamageView]


class RepairView(Changed):
    """The revision after a repair, and what it did, in words."""

    done: list[str]


class Health(BaseModel):
    """Whether the service lives or is ready."""

    status: str


def map_view(record: MapRecord) -> MapView:
    """One line of the list of maps."""
    return MapView.model_validate(vars(record) | {"nodes": record.node_count, "edges": record.edge_count})


def check_view(found: Sequence[Damage]) -> CheckView:
    """What a check found."""
    return CheckView(damage=[DamageView.model_validate(damage) for damage in found])


def keypoints_view(features: Features) -> KeypointsView:
    """Where the features of a node are."""
    return KeypointsView(lonlat_rad=features.lonlat_rad.tolist(), scores=features.scores.tolist())
