"""The nodes that a robot passed, in order, each joined to the next. Pure."""

from collections.abc import Iterable

from shared.mapgraph.graph import MapGraph
from shared.messages.places import LISTED_MAX


class Trail:
    """Grows node by node.

    Args:
        graph: the map.
        begun: nodes passed before; those that are gone are left out.
    """

    def __init__(self, graph: MapGraph, begun: Iterable[int] = ()) -> None:
        self.nodes: tuple[int, ...] = ()
        for node in begun:
            if node in graph.nodes:
                self.reach(graph, node)

    @property
    def is_full(self) -> bool:
        """Whether a route holds no more nodes."""
        return len(self.nodes) >= LISTED_MAX

    def reach(self, graph: MapGraph, node_id: int) -> tuple[int, ...]:
        """The robot is at a node.

        Returns:
            Nodes put in between, where no edge leads there from the last one: the way by the map.
        """
        if not self.nodes:
            self.nodes = (node_id,)
            return ()
        last = self.nodes[-1]
        if node_id == last or self.is_full:
            return ()
        between = () if graph.edge(last, node_id) is not None else tuple(graph.way(last, node_id)[1:-1])
        self.nodes = (*self.nodes, *between, node_id)[:LISTED_MAX]
        return between
