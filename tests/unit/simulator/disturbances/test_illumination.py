"""Time of day: windows go dark, lamps stay."""

from dataclasses import replace

import pytest

from simulator.disturbances.illumination import body_brightness, daylight, illuminated
from simulator.scene.parts import Light, Material, Part

LAMP = Light((0.0, 0.0, 2.0), (0.1, 0.1, 0.1), (1.0, 1.0, 1.0))
PANEL = replace(LAMP, facing=(0.0, 0.0, -1.0))
WINDOW = replace(LAMP, facing=(1.0, 0.0, 0.0))
VIEW = Part("box", (0.0, 0.0, 1.0), (0.01, 1.0, 1.0), Material("view", glow=1.0))
SHADE = replace(VIEW, material=Material("glow", glow=0.9))


def test_level_zero_returns_what_came_in(room):
    contents = ((VIEW,), (LAMP,))
    shown, same = illuminated(room, contents, 0.0)
    assert shown is room
    assert same is contents
    assert body_brightness(0.0) == 1.0


def test_lamps_only_leaves_lamps_and_darkens_windows(room):
    shown, (parts, lights) = illuminated(room, ((VIEW, SHADE), (LAMP, PANEL, WINDOW)), 1.0)
    assert [light.power[0] for light in lights] == [1.0, 1.0, 0.0]
    assert parts[0].material.glow < 0.3
    assert parts[1] is not VIEW
    assert parts[1].material.glow == 0.9
    assert 0.0 < shown.lighting.ambient[0] < room.lighting.ambient[0]


def test_dusk_is_weaker_and_warmer_than_noon():
    noon, dusk, night = daylight(0.0), daylight(0.5), daylight(1.0)
    assert noon == (1.0, 1.0, 1.0)
    assert dusk[0] > dusk[1] > dusk[2] > 0.0
    assert dusk[0] == pytest.approx(0.25)
    assert night == (0.0, 0.0, 0.0)
