"""What REST takes and gives."""

from pydantic import BaseModel, ConfigDict

from services.map_store.catalogue import MapSummary
from services.map_store.history import Revision
from shared.messages.base import Name
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
        quarantined: its features are damaged; it cannot be recognised.
    """

    revision: int
    thumbnail: bool
    quarantined: bool


class EdgeView(Edge):
    """An edge with its evidence and the revision that wrote it last."""

    revision: int


class RevisionView(BaseModel):
    """One entry of the history."""

    model_config = ConfigDict(from_attributes=True)

    revision: int
    author: str
    stamp_ns: int
    steps: int
    undoes: int | None


class Changed(BaseModel):
    """The revision a write led to."""

    map: Name
    revision: int


class Undone(Changed):
    """The revision an undo led to and the one it took back."""

    undone: int


class Health(BaseModel):
    """Whether the service lives or is ready."""

    status: str


def map_view(summary: MapSummary) -> MapView:
    """One line of the list of maps."""
    return MapView.model_validate(summary)


def revision_view(revision: Revision) -> RevisionView:
    """One line of the history."""
    return RevisionView.model_validate(revision)
