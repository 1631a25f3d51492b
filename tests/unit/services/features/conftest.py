"""A textured room seen by a spherical camera, drawn with numpy alone."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.unit.services.features.room import render_room


@pytest.fixture(scope="session")
def room() -> Callable[..., np.ndarray]:
    """`room(x_m, y_m, yaw_rad, height_px)` -> (H, 2H, 3) BGR picture, kept between tests."""
    kept: dict[tuple[float, ...], np.ndarray] = {}

    def draw(x_m: float = 0.0, y_m: float = 0.0, yaw_rad: float = 0.0, height_px: int = 400) -> np.ndarray:
        key = (x_m, y_m, yaw_rad, height_px)
        if key not in kept:
            kept[key] = render_room(*key)
        return kept[key]

    return draw
