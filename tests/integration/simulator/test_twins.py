"""Rooms that are alike look alike: panoramas at the same place of two such rooms."""

from typing import Any

import numpy as np
import pytest

from simulator.settings import CameraSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

pytestmark = pytest.mark.render
APART_M = 5.4  # a multiple of what light and floor are computed in, and of the tiles
PLAIN = {"texture": "ceiling", "colour": [236, 236, 230], "tile_m": 1.8}
BOARDS = {"texture": "boards", "colour": [180, 140, 100], "seed": 3, "tile_m": 1.8}


def world(alike: bool) -> WorldFile:
    rooms = [
        {"name": f"room {k}", "x_m": [k * APART_M, k * APART_M + 3.6], "y_m": [0.0, 3.6],
         "floor": BOARDS, "walls": PLAIN, "ceiling": PLAIN}
        for k in range(2)
    ]  # fmt: skip
    data: dict[str, Any] = {
        "format": "topnav-world/1",
        "name": "two rooms",
        "start": {"x_m": 1.5, "y_m": 1.5},
        "rooms": rooms,
        "openings": [{"x_m": [3.6, APART_M], "y_m": [0.0, 1.0], "floor": BOARDS}],
        "alike": alike,
        "groups": {
            "room": [
                {"kind": "desk", "at_m": [0.0, 2.4], "seed": 1, "options": {"width_m": 1.2}},
                {"kind": "window", "at_m": [1.8, 3.6], "z_m": 0.9, "yaw_deg": -90, "seed": 2},
                {"kind": "wardrobe", "at_m": [3.6, 2.6], "yaw_deg": 180, "seed": 3},
                {"kind": "ceiling_light", "at_m": [1.8, 1.8], "z_m": 2.6},
            ]
        },
        "placed": [{"group": "room", "at_m": [k * APART_M, 0.0]} for k in range(2)],
    }
    return WorldFile.model_validate(data)


def difference(alike: bool) -> float:
    """Mean difference of what is seen to the north, where neither room shows the other; grey levels."""
    settings = SimulationSettings(camera=CameraSettings(width_px=512))
    simulation = Simulation(world(alike), settings)
    views = []
    for k in range(2):
        simulation.place_robot(1.8 + k * APART_M, 1.5, np.pi / 2)
        views.append(simulation.panorama()[:200, 140:372].astype(float))
    return float(np.abs(views[0] - views[1]).mean())


def test_rooms_that_are_alike_give_the_same_picture_and_others_do_not():
    assert difference(alike=True) < 0.5
    assert difference(alike=False) > 3.0
