"""Rearranging where models bring walls and floor: outlines decide, not the boxes round them."""

import pytest

from simulator.generation.brought import BroughtPlaces
from simulator.generation.pieces import piece_at
from simulator.generation.plans.rectangles import Rect
from simulator.importing.import_world import import_world
from tests.unit.simulator.importing.conftest import EXAMPLE


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    return import_world(EXAMPLE, tmp_path_factory.mktemp("brought") / "w").world


@pytest.fixture(scope="module")
def pieces(imported):
    return {
        item.name: piece_at(item.kind, item.at_m, item.yaw_deg, item.seed, item.options, item.z_m)
        for item in imported.furniture
        if item.name
    }


def box(x, y):
    return Rect(x, y, x + 0.4, y + 0.4)


def test_walls_are_in_the_way_only_where_they_stand(imported, pieces):
    places, walls = BroughtPlaces(imported), pieces["walls walls"]
    assert walls.box.gap_m(box(2.0, 1.0)) <= 0.0
    assert places.apart(box(2.0, 1.0), walls, 0.02)
    assert not places.apart(box(3.8, 3.0), walls, 0.02)


def test_no_way_leads_through_a_wall(imported, pieces):
    places, walls = BroughtPlaces(imported), [pieces["walls walls"]]
    assert places.straight_way(box(2.0, 1.0), box(3.0, 2.0), walls)
    assert places.straight_way(box(3.4, 1.8), box(4.4, 1.8), walls), "through the doorway"
    assert not places.straight_way(box(3.4, 3.0), box(4.4, 3.0), walls)


def test_floor_ends_where_the_boards_do(imported):
    places = BroughtPlaces(imported)
    assert places.holds(box(1.0, 1.0))
    assert not places.holds(box(8.0, 4.0))
