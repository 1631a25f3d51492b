"""Which node a mission to a named place or to a sign drives to, and whether the map's rules allow it."""

from services.planner.mission_kinds import MissionError
from services.planner.ports import MapAccess
from shared.mapgraph.local.keep_clear import keep_clear
from shared.mapgraph.marks import place_called, sign_called


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
    return _first_allowed(maps, f"place {place.name!r}", place.nodes)


def node_reading(maps: MapAccess, text: str) -> int:
    """The node from which a sign is read best, of those that no rule forbids.

    Raises:
        MissionError: no sign says that ("missing": the text tells the nearest ones), or all of the nodes that
            it is read from are gone or forbidden.
    """
    sign = sign_called(text, maps.graph.signs)
    if isinstance(sign, str):
        raise MissionError(sign, "missing")
    if not sign.sightings:
        raise MissionError(
            f"sign {sign.name!r} is read from no node any more: explore there again", "missing"
        )
    return _first_allowed(maps, f"sign {sign.name!r}", tuple(one.node for one in sign.sightings))


def _first_allowed(maps: MapAccess, what: str, nodes: tuple[int, ...]) -> int:
    forbidden = maps.limits().forbidden
    allowed = [node for node in nodes if node not in forbidden]
    if not allowed:
        raise MissionError(f"{what} is forbidden by rule {forbidden[nodes[0]]!r}", "forbidden")
    return allowed[0]


def check_allowed(maps: MapAccess, node_id: int) -> None:
    """Raise MissionError where a rule forbids a node."""
    if (rule := maps.limits().forbidden.get(node_id)) is not None:
        raise MissionError(f"node {node_id} is forbidden by rule {rule!r}", "forbidden")


def why_not_beside(
    maps: MapAccess, node_id: int, start_m: tuple[float, float], spot_m: tuple[float, float]
) -> str:
    """Why the rules let no robot go straight to a spot beside a node; "" where they do.

    Args:
        maps: the map with its rules.
        node_id: the node.
        start_m: (2,) where the way begins, in the node's camera frame.
        spot_m: (2,) where it ends, likewise.
    """
    limits = maps.limits()
    around = keep_clear(maps.graph, node_id, limits.forbidden)
    crossed = around is not None and around.is_crossed(start_m, spot_m)
    return limits.why_not({node_id: 0.0}) if crossed or node_id in limits.forbidden else ""
