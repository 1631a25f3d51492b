"""A change to a map that somebody else changed meanwhile, made again so that what both said is kept. Pure."""

from collections.abc import Mapping, Sequence

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.marks import only_nodes
from shared.messages.maps import AddNode, DeleteEdge, DeleteNode, Edge, Node, Operation, PutEdge, UpdateNode
from shared.messages.places import PutRoute, PutSign

COUNTERS = ("traversals", "failures")


def rebased(operations: Sequence[Operation], before: MapGraph, now: MapGraph) -> list[Operation]:
    """The operations as they are to be written on top of `now`.

    New nodes get ids after the newest one, with their edges. Of a node or an edge that both changed, each
    side's changes are kept; counters add up. What concerns something that is gone is left out.

    Args:
        operations: as decided on `before`.
        before: the map they were decided on.
        now: the map as it is.
    """
    first = now.next_id()
    new = [operation.node.node_id for operation in operations if isinstance(operation, AddNode)]
    ids = {node_id: first + number for number, node_id in enumerate(new)}
    again = (_again(operation, before, now, ids) for operation in operations)
    return [operation for operation in again if operation is not None]


def _again(operation: Operation, before: MapGraph, now: MapGraph, ids: Mapping[int, int]) -> Operation | None:
    match operation:
        case AddNode(node=node):
            renamed = node.model_copy(update={"node_id": ids[node.node_id]})
            return operation.model_copy(update={"node": renamed})
        case UpdateNode(node=node):
            theirs = now.nodes.get(node.node_id)
            if theirs is None:
                return None
            return UpdateNode(node=_node(before.nodes.get(node.node_id, node), node, theirs))
        case PutEdge(edge=edge):
            return _put(edge, before, now, ids)
        case DeleteEdge(a=a, b=b):
            return operation if (a, b) in now.edges else None
        case DeleteNode(node_id=node_id):
            return operation if node_id in now.nodes else None
        case PutRoute(route=route):
            return PutRoute(route=only_nodes(route, now.nodes))
        case PutSign(sign=sign):
            return PutSign(sign=only_nodes(sign, now.nodes))
        case _:  # places and rules, which no robot writes
            return operation


def _put(edge: Edge, before: MapGraph, now: MapGraph, ids: Mapping[int, int]) -> PutEdge | None:
    """None where an end is gone, or somebody took the edge away."""
    a, b = ids.get(edge.a, edge.a), ids.get(edge.b, edge.b)
    if any(end not in now.nodes and end not in ids.values() for end in (a, b)):
        return None
    mine = edge.model_copy(update={"a": a, "b": b})
    base, theirs = before.edges.get((edge.a, edge.b)), now.edges.get((a, b))
    if base is None or (edge.a, edge.b) != (a, b):
        return PutEdge(edge=mine)
    return None if theirs is None else PutEdge(edge=_edge(base, mine, theirs))


def _node(base: Node, mine: Node, theirs: Node) -> Node:
    """Their node with what I changed; directions one by one."""

    def merged(name: str) -> tuple[bool, ...]:
        sides = zip(getattr(base, name), getattr(mine, name), getattr(theirs, name), strict=True)
        return tuple(own if own != old else other for old, own, other in sides)

    return theirs.model_copy(update={name: merged(name) for name in ("open", "explored")})


def _edge(base: Edge, mine: Edge, theirs: Edge) -> Edge:
    """Their edge with what I changed."""
    update = {
        name: value for name in Edge.model_fields if (value := getattr(mine, name)) != getattr(base, name)
    }
    for name in COUNTERS:
        more = getattr(mine, name) - getattr(base, name)
        update[name] = max(0, getattr(theirs, name) + more)
    return theirs.model_copy(update=update)
