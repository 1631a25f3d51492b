"""Where tasks begin, by their parameters and the marks of the map."""

import pytest

from services.fleet.beginnings import first_node
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Node
from shared.messages.places import Place, Route, Sighting, Sign
from shared.messages.tasks import Errand

FLAT = MapGraph(
    [Node(node_id=n) for n in range(10)],
    places=[Place(name="Kitchen", nodes=(4, 5)), Place(name="home", nodes=(7,)), Place(name="gone")],
    routes=[Route(name="round", nodes=(1, 2, 3))],
    signs=[Sign(name="214", sightings=(Sighting(node=6, bearing_rad=0.0, height_rad=0.1, confidence=1.0),))],
)


@pytest.mark.parametrize(
    ("kind", "parameters", "node"),
    [
        ("goto", {"goal_node": 3}, 3),
        ("goto", {"goal_node": 30}, None),
        ("goto", {"place": "kitchen"}, 4),
        ("goto", {"place": "bath"}, None),
        ("goto", {"place": "gone"}, None),
        ("goto", {"place": " "}, None),
        ("patrol", {"places": ["KITCHEN", "home"]}, 4),
        ("patrol", {"places": []}, None),
        ("route", {"route": "round"}, 1),
        ("route", {"route": "round", "reverse": True}, 3),
        ("route", {"route": "other"}, None),
        ("goto", {"sign": "room 214"}, 6),
        ("goto", {"sign": "215"}, None),
        ("home", {}, 7),
        ("explore", {}, None),
        ("goto", {"place": 7, "places": "kitchen", "route": 3, "goal_node": "4"}, None),
    ],
)
def test_the_first_node_of_a_task(kind: str, parameters: dict[str, object], node: int | None):
    assert first_node(Errand.model_validate({"kind": kind, "parameters": parameters}), FLAT) == node
