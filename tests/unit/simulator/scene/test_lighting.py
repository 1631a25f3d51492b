"""Light of lamps: what a lamp hangs in casts no shadow, what stands farther off does."""

import numpy as np
import pytest

from simulator.scene.lighting import bake
from simulator.scene.parts import Light, Material
from simulator.scene.shapes import box

UP = np.array([[0.0, 0.0, 1.0]], np.float32)
BELOW = np.array([[0.0, 0.0, 0.0]], np.float32)
WHERE = np.array([[-2.0, -2.0, 0.0], [2.0, 2.0, 3.0]], np.float32)


def lit(clear_m, shade_m):
    """How bright the floor is below a lamp at 2 m with a plate under it at some height."""
    plate = box((-0.5, 0.5), (-0.5, 0.5), (shade_m, shade_m + 0.1), Material("plaster"))
    lamp = Light((0.0, 0.0, 2.0), (0.1, 0.1, 0.1), (3.0, 3.0, 3.0), clear_m=clear_m)
    points, normals = np.concatenate([BELOW, WHERE]), np.repeat(UP, 3, axis=0)
    rng = np.random.default_rng(0)
    return float(bake(points, normals, (plate,), (lamp,), (0.0, 0.0, 0.0), 0.0, rng)[0, 0])


def test_lamp_above_everything_shines_down():
    plate = box((-0.5, 0.5), (-0.5, 0.5), (0.5, 0.6), Material("plaster"))
    lamp = Light((0.0, 0.0, 9.0), (0.1, 0.1, 0.1), (90.0, 90.0, 90.0))
    points = np.array([(0, 0, 0), (1.5, 0, 0), (-2, -2, 0), (2, 2, 1)], np.float32)
    light = bake(
        points, np.repeat(UP, 4, axis=0), (plate,), (lamp,), (0.0,) * 3, 0.0, np.random.default_rng(0)
    )
    assert light[1, 0] > 0.5 > light[0, 0]


@pytest.mark.parametrize(
    ("clear_m", "shade_m", "bright"), [(0.0, 1.6, False), (0.6, 1.6, True), (0.6, 1.0, False)]
)
def test_what_is_near_a_lamp_of_a_model_casts_no_shadow(clear_m, shade_m, bright):
    assert (lit(clear_m, shade_m) > 0.5) == bright
