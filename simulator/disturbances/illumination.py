"""Time of day: daylight goes, lamps stay. Applied to the lights before the static light is computed. Pure.

Daylight is what windows, sky and sun give. It turns warm and weak towards dusk (level 0.5, about a quarter
of noon) and is gone at level 1. The even light, which stands for what walls throw back, loses the share that
was daylight. Shadows and gradients therefore change, as they really do, not just the brightness.
"""

from dataclasses import replace
from typing import Any

from simulator.scene.parts import Contents, Light, Material
from simulator.world.world_file import WorldFile

Rgb = tuple[float, float, float]
LAMP_SHARE = 0.3  # of the even light; chosen
DARKEST_VIEW = 0.05  # a night sky over a town; chosen
DAYLIT = frozenset({"view"})  # textures of what shines by daylight
LOW_SUN: Rgb = (1.0, 0.8, 0.6)  # by eye


def daylight(level: float) -> Rgb:
    """What is left of daylight, RGB factors: 1 at level 0, warm at dusk, 0 at level 1."""
    strength = (1.0 - level) ** 2
    red, green, blue = (strength * tint ** (2.0 * level) for tint in LOW_SUN)
    return red, green, blue


def illuminated(world: WorldFile, contents: Contents, level: float) -> tuple[WorldFile, Contents]:
    """The world and its parts and lights at a time of day; level 0 returns what came in."""
    if level == 0.0:
        return world, contents
    left = daylight(level)
    parts, lights = contents
    even = _times(world.lighting.ambient, tuple(LAMP_SHARE + (1.0 - LAMP_SHARE) * d for d in left))
    changes: dict[str, Any] = {"lighting": world.lighting.model_copy(update={"ambient": even})}
    if world.sun is not None:
        changes["sun"] = world.sun.model_copy(update={"power": _times(world.sun.power, left)})
    view = view_brightness(level)
    dimmed = tuple(replace(part, material=_dimmed(part.material, view)) for part in parts)
    return world.model_copy(update=changes), (dimmed, tuple(_relit(light, left) for light in lights))


def body_brightness(level: float) -> float:
    """How bright things that move are, as a factor for gamma-encoded colours."""
    return 1.0 if level == 0.0 else (LAMP_SHARE + (1.0 - LAMP_SHARE) * daylight(level)[1]) ** (1 / 2.2)


def view_brightness(level: float) -> float:
    """How bright the sky, and what windows show, is: a factor for gamma-encoded colours."""
    return 1.0 if level == 0.0 else max(DARKEST_VIEW, daylight(level)[1]) ** (1 / 2.2)


def _relit(light: Light, left: Rgb) -> Light:
    """A light that faces sideways is a window; one that faces down, or shines all round, is a lamp."""
    if light.facing is None or abs(light.facing[2]) > 0.5:
        return light
    return replace(light, power=_times(light.power, left))


def _dimmed(material: Material, brightness: float) -> Material:
    if material.kind not in DAYLIT or not material.glow:
        return material
    return replace(material, glow=material.glow * brightness)


def _times(colour: Rgb, factors: tuple[float, ...]) -> Rgb:
    red, green, blue = (value * factor for value, factor in zip(colour, factors, strict=True))
    return red, green, blue
