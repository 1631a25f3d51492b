"""An imported scene as the contents of a world file. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from simulator.importing.entities import FloatArray, Lamp, Rgb, Scene, Vec3
from simulator.importing.floor import Floor

NO_LAMP = (0.7, 0.7, 0.7)
"""Even light where a world brings neither lamps nor sun; by eye: as bright as a room with a lamp."""
PLANE = {"texture": "concrete", "colour": [176, 174, 168], "seed": 2, "tile_m": 3.0, "variants": 5}
"""What an endless floor looks like, of which a world says little; ours, as an even grey shows nothing."""
TINY_DEG = 0.01
"""Tilts below are rounding: a centimetre over 60 m."""
Contents = dict[str, Any]


@dataclass(frozen=True)
class Thing:
    """A piece of furniture to be written.

    Attributes:
        name: unique in the world.
        seen, felt: model files relative to the world file; felt "" is the same file, None stops nobody.
        outline: of what is felt.
        pose: in the imported file's frame, (4, 4).
    """

    name: str
    seen: str
    felt: str | None
    outline: str
    pose: FloatArray


def world_contents(name: str, scene: Scene, floor: Floor, things: Sequence[Thing], start: Vec3) -> Contents:
    """What the world file says; the floor is at height 0 in it.

    Args:
        name: of the world.
        scene: lamps, sun and background.
        floor: where it is.
        things: the furniture.
        start: x, y (metres) and heading (degrees) of the robot.
    """
    ground: Contents = {"name": "floor", "x_m": _span(floor.x_m), "y_m": _span(floor.y_m)}
    if floor.endless:
        ground |= {"floor": PLANE} | ({"border": "fence"} if floor.fenced else {})
    contents: Contents = {"format": "topnav-world/1", "name": name}
    if scene.background is not None:
        even = [round(255 * channel) for channel in scene.background]
        contents["sky"] = {"zenith": even, "horizon": even, "clouds": 0.0}
    if scene.sun is not None:
        contents["sun"] = _sun(scene)
    if not scene.lamps and scene.sun is None:
        contents["lighting"] = {"ambient": list(NO_LAMP)}
    contents["start"] = {"x_m": start[0], "y_m": start[1], "yaw_deg": start[2]}
    contents["grounds"] = [ground]
    contents["furniture"] = [
        *(_item(thing, floor.height_m) for thing in things),
        *(_lamp(lamp, floor.height_m) for lamp in scene.lamps),
    ]
    return contents


def _item(thing: Thing, floor_m: float) -> Contents:
    roll, pitch, yaw = angles_deg(thing.pose)
    options: Contents = {"file": thing.seen, "up": "z", "centred": False}
    options |= {"roll_deg": roll} if roll else {}
    options |= {"pitch_deg": pitch} if pitch else {}
    if thing.felt is None:
        options["solid"] = False
    elif thing.felt:
        options["collision"] = {"file": thing.felt, "outline": thing.outline}
    elif thing.outline != "convex":
        options["collision"] = thing.outline
    x, y, z = (round(float(value), 4) for value in thing.pose[:3, 3] - np.array([0.0, 0.0, floor_m]))
    item: Contents = {"kind": "mesh", "name": thing.name, "at_m": [x, y]}
    item |= {"yaw_deg": yaw} if yaw else {}
    item |= {"z_m": z} if z else {}
    return {**item, "options": options}


def angles_deg(pose: FloatArray) -> Vec3:
    """Roll, pitch and yaw of a pose, degrees; what is rounding is 0."""
    r = pose[:3, :3]
    pitch = math.asin(min(1.0, max(-1.0, -float(r[2, 0]))))
    if abs(r[2, 0]) > 1.0 - 1e-9:  # straight down or up: roll and yaw are one turn
        roll, yaw = 0.0, math.atan2(-r[0, 1], r[1, 1])
    else:
        roll, yaw = math.atan2(r[2, 1], r[2, 2]), math.atan2(r[1, 0], r[0, 0])
    turns = [math.degrees(angle) for angle in (roll, pitch, yaw)]
    a, b, c = (0.0 if abs(turn) < TINY_DEG else round(turn, 3) for turn in turns)
    return a, b, c


def _lamp(lamp: Lamp, floor_m: float) -> Contents:
    strength = max(lamp.power)
    colour = [round(255 * channel / strength) for channel in lamp.power] if strength else [0, 0, 0]
    x, y, z = (round(value, 3) for value in lamp.at_m)
    options: Contents = {"strength": round(strength, 2)}
    options |= {"colour": colour} if min(colour) < 255 else {}
    return {"kind": "light", "at_m": [x, y], "z_m": round(z - floor_m, 3), "options": options}


def _sun(scene: Scene) -> Contents:
    if scene.sun is None:
        return {}
    x, y, z = scene.sun.towards
    power: Rgb = scene.sun.power
    return {
        "azimuth_deg": round(math.degrees(math.atan2(y, x)), 1),
        "elevation_deg": round(min(90.0, max(5.0, math.degrees(math.atan2(z, math.hypot(x, y))))), 1),
        "power": [round(channel, 3) for channel in power],
    }


def _span(span: tuple[float, float]) -> list[float]:
    return [round(span[0], 3), round(span[1], 3)]
