"""The mission's map: a copy of the one in the map store."""

from collections.abc import Sequence

from services.planner.ports import RightOfWay
from services.planner.remote.map_changes import MapChanges
from services.planner.remote.traffic import Traffic
from shared.bus import Bus
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.keep_clear import current_limits
from shared.mapgraph.operations import GraphError
from shared.mapgraph.rebasing import rebased
from shared.mapgraph.rules import Limits
from shared.messages.features import Features
from shared.messages.maps import AddNode, DeleteNode, MapDelta, MapReply, MapRequest, Operation
from shared.queries import RefusedError
from shared.topics import MAP
from shared.wall_clock import WallClock

AUTHOR = "planner"
HEARD_S = 0.2
"""What a write came too late for is told at once; longer than a busy store takes for it. Chosen."""
WRITE_TRIES = 10
"""Writes of one change while others write: each other writer may come first a few times in a row."""


class RemoteMap:
    """One map: a copy of its graph that follows the store's revisions.

    Args:
        bus: to the map store.
        name: of the map.
        timeout_s: for an answer.
        traffic: asks for rights of way; None where the robot drives alone.
        changes: tells what others write to this map; without it a write that they preceded reads the map.
    """

    def __init__(
        self,
        bus: Bus,
        name: str,
        timeout_s: float,
        traffic: Traffic | None = None,
        changes: MapChanges | None = None,
    ) -> None:
        self._bus, self.name, self._timeout_s, self._traffic = bus, name, timeout_s, traffic
        self._changes = changes
        self.graph = MapGraph()
        self.revision = 0

    def load(self, *, create: bool) -> None:
        """Read the map, making it first when `create` and it is missing; RefusedError when it is missing."""
        try:
            reply = self._ask(MapRequest(action="read"))
        except RefusedError as error:
            if not create or not error.may_be_missing:
                raise
            self._create()
            reply = self._ask(MapRequest(action="read"))
        self.graph = MapGraph(reply.nodes, reply.edges, reply.places, reply.rules, reply.routes, reply.signs)
        self.revision = reply.revision

    def follow(self, delta: MapDelta) -> None:
        """Take over what somebody else wrote; after a gap, and where nodes went, the map is read again.

        What is known already is passed over.
        """
        if delta.revision <= self.revision and not delta.reset:
            return
        gone = any(isinstance(operation, DeleteNode) for operation in delta.operations)
        if delta.reset or gone or delta.revision != self.revision + 1:
            self.load(create=False)
            return
        try:
            self.graph.apply(delta.operations)
        except GraphError:  # the copy was not what it should be
            self.load(create=False)
            return
        self.revision = delta.revision

    def commit(self, operations: Sequence[Operation]) -> None:
        """Write all or none; where somebody else wrote meanwhile, add the change to theirs."""
        for left in reversed(range(WRITE_TRIES)):
            try:
                reply = self._transact(operations)
                break
            except RefusedError as error:
                before, revision = self._nodes_and_edges(), self.revision
                if error.code != "conflict" or not self._heard_others():
                    self.load(create=False)
                if self.revision == revision or not left or self._has(operations):
                    raise
                operations = rebased(operations, before, self.graph)
                if not operations:
                    return
        self.graph.apply(operations)
        self.revision = reply.revision

    def _nodes_and_edges(self) -> MapGraph:
        """As they are now, whatever is applied later."""
        return MapGraph(self.graph.nodes.values(), self.graph.edges.values())

    def _heard_others(self) -> bool:
        """Whether what others wrote was told already; a busy map is not read whole for each write."""
        if self._changes is None:
            return False
        revision, told = self.revision, self._changes.wait(HEARD_S)
        while told and not (told[0].reset or told[0].renamed_to):
            self.follow(told.pop(0))
        self._changes.put_back(told)  # of a map that went or is called otherwise the mission has to hear
        return self.revision > revision

    def limits(self) -> Limits:
        """What the rules of the map say at this minute."""
        return current_limits(self.graph, WallClock.now())

    def _create(self) -> None:
        """Make the map, if no other robot makes it just now."""
        try:
            self._ask(MapRequest(action="create", author=AUTHOR))
        except RefusedError as error:
            if error.code != "conflict":
                raise

    def _has(self, operations: Sequence[Operation]) -> bool:
        """Whether the map has the new nodes already: they were written, only the answer got lost."""
        new = [operation.node for operation in operations if isinstance(operation, AddNode)]
        there = [self.graph.nodes.get(node.node_id) for node in new]
        return any(a is not None and a.stamp_ns == b.stamp_ns for a, b in zip(there, new, strict=True))

    def features_of(self, node_id: int) -> Features:
        """What a node looks like."""
        return self._ask(MapRequest(action="read_features", node_ids=(node_id,))).features[0].features

    @property
    def shared(self) -> bool:
        """Whether the fleet service has to be asked for the right of way."""
        return self._traffic is not None and self._traffic.is_regulated

    def right_of_way(self, at: Sequence[int], ahead: Sequence[int]) -> RightOfWay:
        """How far the robot may go along its way, by what the fleet service says."""
        if self._traffic is None:
            return RightOfWay(len(ahead))
        return self._traffic.ask(self.name, at, ahead)

    def _transact(self, operations: Sequence[Operation]) -> MapReply:
        return self._ask(
            MapRequest(
                action="transact", author=AUTHOR, base_revision=self.revision, operations=tuple(operations)
            )
        )

    def _ask(self, request: MapRequest) -> MapReply:
        return self._bus.ask(MAP, request, self._timeout_s, map=self.name)
