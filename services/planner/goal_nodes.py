"""Which node a mission to a named place drives to, and whether the rules of the map allow it."""

from services.planner.mission_kinds import MissionError
from services.planner.ports import MapAccess
from shared.mapgraph.marks import place_called


def node_called(maps: MapAccess, name: str) -> int:
    """The first node of a place that no rule forbids.

    Raises:
        MissionError: no place of that name ("missing": the text tells the nearest ones), or all of its nodes
            are forbidden.
    """
    place = place_called(name, maps.graph.places)
    if isinstance(place, str):
        raise MissionError(place, "missing")
    if not place.nodes:
        raise MissionError(f"place {place.name!r} has no nodes left: name it again", "missing")
    forbidden = maps.limits().forbidden
    allowed = [node for node in place.nodes if node not in forbidden]
    if not allowed:
        raise MissionError(
            f"place {place.name!r} is forbidden by rule {forbidden[place.nodes[0]]!r}", "forbidden"
        )
    return allowed[0]


def check_allowed(maps: MapAccess, node_id: int) -> None:
    """Raise MissionError where a rule forbids a node."""
    if (rule := maps.limits().forbidden.get(node_id)) is not None:
        raise MissionError(f"node {node_id} is forbidden by rule {rule!r}", "forbidden")
