"""A small furnished room, quick to render."""

from typing import Any

import pytest
import yaml

PAINT = {"texture": "lacquer", "colour": [200, 200, 200]}


@pytest.fixture(scope="session")
def room_data() -> dict[str, Any]:
    """Room of 4 x 4 m, robot in the middle looking along x, a picture on each of three walls."""
    return {
        "format": "topnav-world/1",
        "name": "small",
        "start": {"x_m": 2.0, "y_m": 2.0},
        "rooms": [
            {"name": "room", "x_m": [0, 4], "y_m": [0, 4], "floor": PAINT, "walls": PAINT, "ceiling": PAINT}
        ],
        "furniture": [
            {
                "kind": "rug",
                "at_m": [2.0, 3.2],
                "options": {"length_m": 0.6, "width_m": 0.6, "colour": [230, 20, 20]},
            },
            {
                "kind": "picture",
                "at_m": [4.0, 2.0],
                "z_m": 1.0,
                "yaw_deg": 180,
                "options": {"style": "abstract"},
            },
            {
                "kind": "picture",
                "at_m": [2.0, 0.0],
                "z_m": 1.0,
                "yaw_deg": 90,
                "options": {"style": "poster"},
            },
            {"kind": "ceiling_light", "at_m": [2.0, 2.0], "z_m": 2.6},
        ],
    }


@pytest.fixture(scope="session")
def room_file(room_data, tmp_path_factory) -> str:
    """The small room as a file."""
    path = tmp_path_factory.mktemp("world") / "small.yaml"
    path.write_text(yaml.safe_dump(room_data), encoding="utf-8")
    return str(path)
