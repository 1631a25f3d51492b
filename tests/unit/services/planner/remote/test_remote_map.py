"""The planner's copy of a map, and what others write to it."""

from services.planner.remote.remote_map import RemoteMap
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, MapDelta, MapReply, Node, PutEdge


class Store:
    """A bus on which every question about maps has the same answer."""

    def ask(self, _query, _request, _timeout_s, **_names):
        return MapReply(map="flat", revision=7, nodes=(Node(node_id=1), Node(node_id=2)))


def test_a_delta_that_does_not_fit_the_copy_has_the_map_read_again():
    maps = RemoteMap(Store(), "flat", 1.0)
    maps.graph, maps.revision = MapGraph([Node(node_id=1)]), 6
    maps.follow(MapDelta(map="flat", revision=7, operations=(PutEdge(edge=Edge(a=1, b=2)),)))
    assert (set(maps.graph.nodes), maps.revision) == ({1, 2}, 7)
