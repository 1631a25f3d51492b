"""What a world is like before anybody drives in it: size, free floor, faults and doubts. Pure."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from simulator.scene.parts import Part
from simulator.world.brought_floor import CELL_M, brought
from simulator.world.contents import expand, placed
from simulator.world.floating import floating
from simulator.world.footprints import clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, FreeSpace, free_space
from simulator.world.passages import Passage, narrow_passages
from simulator.world.world_file import WorldFile

ROBOT_RADIUS_M = 0.26  # the body and a centimetre
MOST_LOOKS = 480  # the renderer's table has 512, and the robots need some
TOUCH_M = 1e-6  # rounding
TIGHT_M = 2 * ROBOT_RADIUS_M + 0.1  # chosen: 5 cm to spare on either side


@dataclass(frozen=True)
class WorldReport:
    """Figures of a world; `faults` keep it from being used, `doubts` are worth a look."""

    name: str
    size_m: tuple[float, float]
    floor_m2: float
    free_m2: float
    cut_off_m2: float
    rooms: int
    parts: int
    solids: int
    lights: int
    looks: int
    start_free: bool
    unreachable: tuple[str, ...]
    passages: tuple[Passage, ...]
    faults: tuple[str, ...]
    doubts: tuple[str, ...]


def examine(world: WorldFile, robot_radius_m: float = ROBOT_RADIUS_M) -> WorldReport:
    """Look at a world that has loaded."""
    parts, lights = expand(world)
    rects = world.rectangles()
    looks = len({part.material for part in parts})
    at_start, doubts = start_faults(world, robot_radius_m, parts), _opening_doubts(world)
    faults = list(at_start)
    if looks > MOST_LOOKS:
        faults.append(
            f"at most {MOST_LOOKS} different materials can be shown, got {looks}; share colours and seeds"
        )
    if not lights and not any(part.material.glow for part in parts) and not getattr(world, "sun", None):
        doubts.append("no lamps: only the even light of `lighting` is there; add a ceiling_light")
    space = None if faults else free_space(world, robot_radius_m, parts=parts)
    cell = space.resolution_m**2 if space else 0.0
    lost = _unreachable(world, space) if space else ()
    doubts += [f"{name}: the robot cannot get there from the start" for name in lost]
    passages = tuple(narrow_passages(space)) if space else ()
    doubts += [
        f"passage at ({p.x_m}, {p.y_m}) is {p.width_m} m wide, the robot {2 * robot_radius_m:.2f} m: tight"
        for p in passages if p.width_m < TIGHT_M
    ]  # fmt: skip
    if in_the_air := floating(world):
        doubts.append(f"nothing holds {', '.join(in_the_air[:8])}{' ...' if len(in_the_air) > 8 else ''}")
    return WorldReport(
        name=world.name,
        size_m=(
            round(max(x[1] for x, _ in rects) - min(x[0] for x, _ in rects), 3),
            round(max(y[1] for _, y in rects) - min(y[0] for _, y in rects), 3),
        ),
        floor_m2=round(_floor_m2(world, parts), 2),
        free_m2=round(float(space.free.sum()) * cell, 2) if space else 0.0,
        cut_off_m2=round(float(cut_off(space).sum()) * cell, 2) if space else 0.0,
        rooms=len(world.rooms),
        parts=len(parts),
        solids=sum(part.solid for part in parts),
        lights=len(lights),
        looks=looks,
        start_free=not at_start,
        unreachable=lost,
        passages=passages,
        faults=tuple(faults),
        doubts=tuple(doubts),
    )


def _floor_m2(world: WorldFile, parts: tuple[Part, ...]) -> float:
    """Area of all floor; of what furniture brings, as many cells as it covers."""
    rects = [(a.x_m, a.y_m) for a in (*world.rooms, *world.openings)]
    rects += [(ground.x_m, ground.y_m) for ground in world.grounds if ground.floor is not None]
    total = sum((x[1] - x[0]) * (y[1] - y[0]) for x, y in rects)
    for ground in world.grounds:
        if ground.floor is None:
            xs, ys = (np.arange(low, high, CELL_M) for low, high in (ground.x_m, ground.y_m))
            total += float(brought(parts, xs, ys).sum()) * CELL_M**2
    return total


def start_faults(
    world: WorldFile, robot_radius_m: float = ROBOT_RADIUS_M, parts: tuple[Part, ...] | None = None
) -> list[str]:
    """What stands where the robot starts, and how far it would have to be.

    Args:
        world: the world.
        robot_radius_m: of the robot's disc.
        parts: those of the world, where they are known.
    """
    parts = expand(world)[0] if parts is None else parts
    start = np.array([[world.start.x_m, world.start.y_m]])
    gap = float(clearance_m(start, footprints(parts, *BODY_BAND_M))[0])
    if gap >= robot_radius_m:
        return []
    nearest, name = math.inf, "a wall"
    for k, item in enumerate(world.furniture):
        distance = float(clearance_m(start, footprints(placed(item).parts, *BODY_BAND_M))[0])
        if distance < min(nearest, gap + 1e-6):
            nearest, name = distance, f"furniture.{k} ({item.kind})"
    return [
        f"start ({world.start.x_m:g}, {world.start.y_m:g}) must be {robot_radius_m:g} m from everything, "
        f"{name} is {gap:.2f} m away; move one of them"
    ]


def cut_off(space: FreeSpace) -> npt.NDArray[np.bool_]:
    """Free floor that is not reached, without the land round a place that is closed in."""
    lost = (space.clearance_m >= space.robot_radius_m) & ~space.free
    border = np.ones(lost.shape, bool)
    border[1:-1, 1:-1] = False
    if (space.free & border).any():
        return np.asarray(lost)
    _, labels = cv2.connectedComponents(lost.astype(np.uint8), connectivity=4)
    outside = np.unique(labels[border & lost])
    return np.asarray(lost & ~np.isin(labels, outside))


def _unreachable(world: WorldFile, space: FreeSpace) -> tuple[str, ...]:
    """Rooms and grounds in which no reachable floor lies."""
    reached = space.centres_m()
    lost = []
    for area in (*world.rooms, *getattr(world, "grounds", ())):
        inside = (reached >= (area.x_m[0], area.y_m[0])) & (reached <= (area.x_m[1], area.y_m[1]))
        if not inside.all(axis=1).any():
            lost.append(area.name)
    return tuple(lost)


def _opening_doubts(world: WorldFile) -> list[str]:
    """Openings that do not join two pieces of floor."""
    doubts = []
    areas = (*world.rooms, *getattr(world, "grounds", ()), *world.openings)
    for k, opening in enumerate(world.openings):
        own = (opening.x_m, opening.y_m)
        joined = sum(_touch(own, (area.x_m, area.y_m)) for area in areas if area is not opening)
        if joined < 2:
            doubts.append(
                f"openings.{k} must touch two rooms along a wall, it touches {joined}: "
                "put its edges on the edges of both"
            )
    return doubts


def _touch(a: tuple[tuple[float, float], ...], b: tuple[tuple[float, float], ...]) -> bool:
    """Whether two rectangles share a piece of an edge, or overlap."""
    gaps = [max(a[k][0], b[k][0]) - min(a[k][1], b[k][1]) for k in (0, 1)]
    return max(gaps) < TOUCH_M and min(gaps) < -TOUCH_M
