"""What REST gives of a map's history."""

from pydantic import BaseModel, ConfigDict, Field

from services.map_store.history.comparison import Comparison, Value
from services.map_store.history.revisions import Revision
from shared.mapgraph.operations import EdgeKey
from shared.messages.base import Name


class RevisionView(BaseModel):
    """One entry of the history.

    Attributes:
        author: who wrote it.
        steps: how many single changes it is made of; `summary` says which.
        undoes: the revision it took back.
    """

    model_config = ConfigDict(from_attributes=True)

    revision: int
    author: str
    stamp_ns: int
    steps: int
    undoes: int | None
    summary: str


class EdgeChangeView(BaseModel):
    """An edge of both revisions, with the fields that differ."""

    model_config = ConfigDict(from_attributes=True)

    a: int
    b: int
    before: dict[str, Value]
    after: dict[str, Value]


class ComparisonView(BaseModel):
    """What leads from revision `from` to revision `to`; edges as pairs of their nodes, a < b."""

    model_config = ConfigDict(from_attributes=True)

    map: Name
    start: int = Field(alias="from")
    end: int = Field(alias="to")
    nodes_added: list[int]
    nodes_removed: list[int]
    nodes_changed: list[int]
    edges_added: list[EdgeKey]
    edges_removed: list[EdgeKey]
    edges_changed: list[EdgeChangeView]


def revision_view(revision: Revision) -> RevisionView:
    """One line of the history."""
    return RevisionView.model_validate(revision)


def comparison_view(name: str, start: int, end: int, comparison: Comparison) -> ComparisonView:
    """Two revisions of a map beside one another."""
    return ComparisonView.model_validate({"map": name, "from": start, "to": end} | vars(comparison))
