"""A piece in a doorway shuts off what lies behind it; one beside it does not."""

import pytest

from experiments.changes.alterations import Alteration
from experiments.changes.passages import shuts_off
from shared.messages.simulation import Pose
from simulator.world.changes import item_names
from simulator.world.world_file import load_world


@pytest.fixture(scope="module")
def apartment():
    return load_world("apartment")


def moved(world, name, x_m, y_m):
    item = dict(zip(item_names(world), world.furniture, strict=True))[name]
    return Alteration(name, "moved", item.at_m, (x_m, y_m), Pose(x_m=x_m, y_m=y_m, yaw_rad=0.0), 0.3)


def test_a_piece_in_a_doorway_shuts_off_what_lies_behind_it(apartment):
    places = [(2.6, 1.3), (0.0, -1.0)]
    doorway = moved(apartment, "pouf-1", 1.7, -0.3)
    assert shuts_off(apartment, [doorway], places)
    assert not shuts_off(apartment, [moved(apartment, "pouf-1", 2.6, 1.9)], places)
    assert not shuts_off(apartment, [doorway], places[:1]), "all that is wanted lies on one side"


def test_a_piece_that_is_taken_away_leaves_the_ways(apartment):
    places = [(2.6, 1.3), (0.0, -1.0)]
    gone = Alteration("plant-1", "removed", (0.0, 0.0), None, None, 0.3)
    assert not shuts_off(apartment, [gone], places)
    assert shuts_off(apartment, [gone, moved(apartment, "pouf-1", 1.7, -0.3)], places)
