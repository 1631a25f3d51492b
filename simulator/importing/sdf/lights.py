"""<light> of SDF -> lamps and sunshine. Pure."""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

from simulator.importing.entities import Lamp, Sunshine
from simulator.importing.sdf.frames import Frames
from simulator.importing.sdf.numbers import number_of, numbers, rgb_of, text_of
from simulator.scene.lighting import SOFT_M2

LIKE_M = 2.0
"""Where a lamp is as bright as the file has it; chosen: from a ceiling's height both fall off much alike."""
MOST_POWER = 20.0
"""Brighter than a hall's lamp; chosen."""
DAYLIGHT = Sunshine((0.5, -0.1, 0.9), (0.8, 0.8, 0.8))
"""Of the model "sun" that Gazebo brings; a direction against that of its light."""


def lamps_of(top: ElementTree.Element, path: Path, frames: Frames) -> Iterator[Lamp]:
    """Point and spot lights of a world; a spot shines all round."""
    for light in top.iterfind("light"):
        where = f"{path}: light {light.get('name', '')!r:.60}"
        if light.get("type") not in {"point", "spot"}:
            continue
        x, y, z = frames.pose(light, where)[:3, 3].tolist()
        fall = [
            number_of(light, f"attenuation/{part}", default, where)
            for part, default in (("constant", 1.0), ("linear", 0.0), ("quadratic", 0.0))
        ]
        at_like = max(1e-3, sum(abs(part) * LIKE_M**k for k, part in enumerate(fall)))
        strength = number_of(light, "intensity", 1.0, where) * (SOFT_M2 + LIKE_M**2) / at_like
        r, g, b = rgb_of(light, "diffuse", where) or (1.0, 1.0, 1.0)
        yield Lamp((x, y, z), (_power(r, strength), _power(g, strength), _power(b, strength)))


def sun_of(top: ElementTree.Element, path: Path, included: bool) -> Sunshine | None:
    """The first directional light of a world, or that of Gazebo's own model."""
    for light in top.iterfind("light"):
        if light.get("type") != "directional":
            continue
        where = f"{path}: light {light.get('name', '')!r:.60}"
        x, y, z = numbers(text_of(light, "direction") or "0 0 -1", 3, f"{where}: direction must be x y z")
        r, g, b = rgb_of(light, "diffuse", where) or (1.0, 1.0, 1.0)
        if not math.hypot(x, y, z) > 0.0 or max(r, g, b) == 0.0:
            continue
        return Sunshine((-x, -y, -z), (r, g, b))
    return DAYLIGHT if included else None


def _power(colour: float, strength: float) -> float:
    return min(MOST_POWER, max(0.0, colour * strength))
