"""Where a task begins: the node of the map to which its robot has to drive first. Pure."""

from pydantic import JsonValue

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.marks import sign_called
from shared.messages.places import key_of
from shared.messages.tasks import Errand

HOME = "home"
"""The kind of mission that drives to the place of that name, which is no parameter."""


def first_node(errand: Errand, graph: MapGraph) -> int | None:
    """The node at which it begins, by the names that parameters of all kinds share; None for none known."""
    given = errand.parameters
    node = given.get("goal_node")
    if isinstance(node, int):
        return node if node in graph.nodes else None
    nodes: tuple[int, ...] = ()
    if isinstance(route := given.get("route"), str):
        known = graph.routes.get(_key(route))
        nodes = () if known is None else known.nodes
        nodes = nodes[::-1] if given.get("reverse") else nodes
    elif isinstance(text := given.get("sign"), str):
        sign = sign_called(text, graph.signs)
        nodes = () if isinstance(sign, str) else tuple(one.node for one in sign.sightings)
    elif (place := _first_place(errand)) is not None:
        there = graph.places.get(_key(place))
        nodes = () if there is None else there.nodes
    return nodes[0] if nodes else None


def _first_place(errand: Errand) -> str | None:
    place: JsonValue = errand.parameters.get("place", HOME if errand.kind == HOME else None)
    places = errand.parameters.get("places")
    if place is None and isinstance(places, list) and places:
        place = places[0]
    return place if isinstance(place, str) else None


def _key(name: str) -> str:
    try:
        return key_of(name)
    except ValueError:  # no place has such a name
        return ""
