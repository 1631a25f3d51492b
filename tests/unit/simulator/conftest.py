"""A plain room of 6 x 4 m with one table, for tests that need known distances."""

from typing import Any

import pytest

from simulator.settings import RangeSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

PAINT = {"texture": "lacquer", "colour": [200, 200, 200]}


@pytest.fixture(scope="session")
def room_data() -> dict[str, Any]:
    """World file of the plain room: x 0..6, y 0..4, a 1 x 1 m table with its middle at (5, 3)."""
    return {
        "format": "topnav-world/1",
        "name": "plain",
        "start": {"x_m": 2.0, "y_m": 2.0},
        "rooms": [
            {"name": "room", "x_m": [0, 6], "y_m": [0, 4], "floor": PAINT, "walls": PAINT, "ceiling": PAINT}
        ],
        "furniture": [
            {"kind": "dining_table", "at_m": [5.0, 3.0], "options": {"length_m": 1.0, "width_m": 1.0}}
        ],
    }


@pytest.fixture(scope="session")
def room(room_data: dict[str, Any]) -> WorldFile:
    """The plain room."""
    return WorldFile.model_validate(room_data)


@pytest.fixture
def simulation(room: WorldFile) -> Simulation:
    """The plain room without rendering and without sensor noise."""
    return Simulation(room, SimulationSettings(render=False, ranges=RangeSettings(noise_m=0.0)), seed=3)
