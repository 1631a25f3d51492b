"""What REST takes and gives."""

from pydantic import BaseModel, ConfigDict, Field

from services.map_store.history.comparison import Comparison, EdgeChange
from services.map_store.integrity.check import Damage
from services.map_store.storage.catalogue import MapRecord
from shared.mapgraph.operations import EdgeKey
from shared.messages.base import Name
from shared.messages.features import Features
from shared.messages.maps import Edge, Node


class MapView(BaseModel):
    """One map."""

    name: Name
    revision: int
    nodes: int
    edges: int
    created_ns: int
    changed_ns: int


class NewMapName(BaseModel):
    """Name of a map to make, or another one for a map."""

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


class CheckView(BaseModel):
    """Everything that is damaged."""

    damage: list[Damage]


class ComparisonView(BaseModel):
    """What leads from revision `from` to revision `to`; edges as pairs of their nodes, a < b."""

    map: Name
    start: int = Field(alias="from")
    end: int = Field(alias="to")
    nodes_added: list[int]
    nodes_removed: list[int]
    nodes_changed: list[int]
    edges_added: list[EdgeKey]
    edges_removed: list[EdgeKey]
    edges_changed: list[EdgeChange]
    places_added: list[str]
    places_removed: list[str]
    places_changed: list[str]
    rules_added: list[str]
    rules_removed: list[str]
    rules_changed: list[str]
    routes_added: list[str]
    routes_removed: list[str]
    routes_changed: list[str]
    signs_added: list[str]
    signs_removed: list[str]
    signs_changed: list[str]


class Health(BaseModel):
    """Whether the service lives or is ready."""

    status: str


def map_view(record: MapRecord) -> MapView:
    """One line of the list of maps."""
    return MapView.model_validate(vars(record) | {"nodes": record.node_count, "edges": record.edge_count})


def comparison_view(name: str, start: int, end: int, comparison: Comparison) -> ComparisonView:
    """Two revisions of a map beside one another."""
    return ComparisonView.model_validate({"map": name, "from": start, "to": end} | vars(comparison))


def keypoints_view(features: Features) -> KeypointsView:
    """Where the features of a node are."""
    return KeypointsView(lonlat_rad=features.lonlat_rad.tolist(), scores=features.scores.tolist())
