"""The map: a graph of nodes, written by transactions, followed by deltas. Planner <-> map store."""

import uuid
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from shared.messages.base import SECTORS, Bearing, Message, Name, Part
from shared.messages.features import MAX_THUMBNAIL_BYTES, Features
from shared.messages.missions import FailureKind, KindName, Parameters, PausedBy
from shared.messages.places import (
    DeletePlace,
    DeleteRoute,
    DeleteRule,
    DeleteSign,
    Place,
    PutPlace,
    PutRoute,
    PutRule,
    PutSign,
    Route,
    Rule,
    Sign,
)

Ways = Annotated[
    tuple[Annotated[float, Field(ge=0.0)], ...],
    Field(min_length=SECTORS, max_length=SECTORS, fail_fast=True),
]
Sectors = Annotated[tuple[bool, ...], Field(min_length=SECTORS, max_length=SECTORS, fail_fast=True)]
MAP_ITEMS = 2_000_000
"""Values in one message about a map: 20,000 nodes with 12 directions each, and as many edges."""


class Node(Part):
    """A node. Its features and thumbnail are kept apart, see `AddNode`.

    Attributes:
        stamp_ns: capture time of its frame.
        frame_seq: number of its frame.
        open: directions (node's camera frame) in which the distance sensors saw room.
        free_m: how far the robot could go in each direction; None where nobody measured.
        echoes_m: what the distance sensors read in each direction; None where nobody measured.
        explored: directions already known: an edge leads there or the robot left that way.
    """

    node_id: int = Field(ge=0)
    stamp_ns: int = Field(default=0, ge=0)
    frame_seq: int = Field(default=0, ge=0)
    pipeline: str = ""
    keypoints: int = Field(default=0, ge=0)
    open: Sectors = (False,) * SECTORS
    free_m: Ways | None = None
    echoes_m: Ways | None = None
    explored: Sectors = (False,) * SECTORS


class Edge(Part):
    """Two nodes seen from one another, with the evidence. Always a < b.

    Attributes:
        heading_ab_rad: direction from a to b in a's camera frame.
        heading_ba_rad: direction from b to a in b's camera frame.
        yaw_ab_rad: rotation from a's camera to b's.
        s_min, s_max: thresholds in force when it was made.
        clear: the distance sensors saw free ground all the way.
        length_m: how far the robot went from one to the other when it made the edge, by its own commands or
            odometry; None where it did not. length_std_m: its standard deviation.
        traversals: times the robot drove it; failures: times it tried in vain.
    """

    a: int = Field(ge=0)
    b: int = Field(ge=0)
    raw_matches: int = Field(default=0, ge=0)
    inliers: int = Field(default=0, ge=0)
    confidence: float = Field(default=0.0, ge=0.0, le=1.0)
    heading_ab_rad: Bearing | None = None
    heading_ba_rad: Bearing | None = None
    yaw_ab_rad: Bearing | None = None
    disparity_rad: float | None = None
    s_min: int = Field(default=0, ge=0)
    s_max: int = Field(default=0, ge=0)
    pipeline: str = ""
    clear: bool = False
    length_m: float | None = Field(default=None, ge=0.0)
    length_std_m: float | None = Field(default=None, ge=0.0)
    traversals: int = Field(default=0, ge=0)
    failures: int = Field(default=0, ge=0)
    suspended: bool = False
    why: str = Field(default="", max_length=200)

    @model_validator(mode="after")
    def _ordered(self) -> "Edge":
        if self.a >= self.b:
            raise ValueError(f"edge must have a < b, got a={self.a}, b={self.b}")
        return self


class AddNode(Part):
    """Add a node with what it looks like."""

    op: Literal["add_node"] = "add_node"
    node: Node
    features: Features


class UpdateNode(Part):
    """Replace what is known about a node's surroundings."""

    op: Literal["update_node"] = "update_node"
    node: Node


class DeleteNode(Part):
    """Remove a node and its edges."""

    op: Literal["delete_node"] = "delete_node"
    node_id: int = Field(ge=0)


class PutEdge(Part):
    """Add an edge or replace the one between the same nodes."""

    op: Literal["put_edge"] = "put_edge"
    edge: Edge


class DeleteEdge(Part):
    """Remove an edge."""

    op: Literal["delete_edge"] = "delete_edge"
    a: int = Field(ge=0)
    b: int = Field(ge=0)


MarkOperation = PutPlace | DeletePlace | PutRule | DeleteRule | PutRoute | DeleteRoute | PutSign | DeleteSign
Operation = Annotated[
    AddNode | UpdateNode | DeleteNode | PutEdge | DeleteEdge | MarkOperation, Field(discriminator="op")
]


class MapRequest(Message):
    """Read or write one map.

    Actions: create (fails if it exists), read (graph only), read_features and read_pictures (of node_ids, all
    if empty), transact (all operations or none; refused when base_revision is given and is not the newest).

    Attributes:
        request_id: of a write; asked again with the same one it is answered again and not done again.
    """

    SCHEMA: ClassVar[str] = "map_request.v1"
    MAX_ITEMS: ClassVar[int] = MAP_ITEMS

    action: Literal["create", "read", "read_features", "read_pictures", "transact"]
    author: str = Field(default="", max_length=64)
    base_revision: int | None = None
    request_id: str = Field(default_factory=lambda: uuid.uuid4().hex, pattern=r"^[A-Za-z0-9_-]{0,64}$")
    operations: tuple[Operation, ...] = Field(default=(), max_length=10_000, fail_fast=True)
    node_ids: tuple[int, ...] = Field(default=(), max_length=10_000, fail_fast=True)


class NodeFeatures(Part):
    """The features of one node."""

    node_id: int
    features: Features


class NodePicture(Part):
    """What one node looks like: the `thumbnail` of its features, a JPEG; empty where it has none."""

    node_id: int
    picture: bytes = Field(max_length=MAX_THUMBNAIL_BYTES)


class MapReply(Message):
    """The map after the request; nodes, edges and marks only for read."""

    SCHEMA: ClassVar[str] = "map_reply.v1"
    MAX_ITEMS: ClassVar[int] = MAP_ITEMS

    map: Name
    revision: int = Field(ge=0)
    nodes: tuple[Node, ...] = Field(default=(), fail_fast=True)
    edges: tuple[Edge, ...] = Field(default=(), fail_fast=True)
    places: tuple[Place, ...] = Field(default=(), fail_fast=True)
    rules: tuple[Rule, ...] = Field(default=(), fail_fast=True)
    routes: tuple[Route, ...] = Field(default=(), fail_fast=True)
    signs: tuple[Sign, ...] = Field(default=(), fail_fast=True)
    features: tuple[NodeFeatures, ...] = Field(default=(), fail_fast=True)
    pictures: tuple[NodePicture, ...] = Field(default=(), fail_fast=True)


class MapDelta(Message):
    """The operations that led from revision - 1 to revision. A gap means: read the map again.

    Attributes:
        reset: the map was replaced, deleted, renamed or undone: read it again whatever revision you hold.
        renamed_to: its new name, under which it is the same; "" where it keeps its name.
    """

    SCHEMA: ClassVar[str] = "map_delta.v1"
    MAX_ITEMS: ClassVar[int] = MAP_ITEMS

    map: Name
    revision: int = Field(ge=0)
    reset: bool = False
    renamed_to: str = Field(default="", pattern=r"^[a-z0-9_-]{0,64}$")
    author: str = ""
    operations: tuple[Operation, ...] = Field(default=(), fail_fast=True)


class MissionRecord(Message):
    """A mission as kept by the map store, so that a planner that restarts goes on with it.

    Attributes:
        action: kind of mission; "" once it has ended: then `ended_action` says what it was, `outcome` and
            what follows how.
        checkpoint: how far it has got, in words of its kind.
    """

    SCHEMA: ClassVar[str] = "mission_record.v1"

    robot: Name
    epoch: int = Field(default=0, ge=0)
    mission_id: str = ""
    action: KindName = ""
    map: Name = "default"
    parameters: Parameters = Field(default_factory=dict)
    checkpoint: Parameters = Field(default_factory=dict)
    goal: Features | None = None
    goal_node: int | None = None
    seed: int = 0
    max_steps: int = 20_000
    step: int = 0
    paused: bool = False
    paused_by: PausedBy = ""
    ended_action: KindName = ""
    outcome: Literal["", "succeeded", "failed", "cancelled"] = ""
    failure: FailureKind = ""
    reason: str = Field(default="", max_length=400)


class MissionRecordRequest(Message):
    """claim: a planner starts, gets the record with epoch + 1; save: store it (refused if epoch is older)."""

    SCHEMA: ClassVar[str] = "mission_record_request.v1"

    action: Literal["claim", "save"]
    record: MissionRecord
