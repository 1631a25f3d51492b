"""The plan of a world in the thesis's style: yellow border, dark-grey objects, a grid of 0.5 or 5 m."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle

from simulator.scene.parts import Part, solids_between
from simulator.world.contents import expand
from simulator.world.footprints import hull_corners_m
from simulator.world.freespace import BODY_BAND_M
from simulator.world.grounds import ground_parts
from simulator.world.rooms import room_parts
from simulator.world.world_file import WorldFile

BORDER = "#f2c500"
OBJECT = "#4a4a4a"
GRID_M, WIDE_GRID_M, WIDE_M = 0.5, 5.0, 30.0  # the thesis's 5 m outdoors
MARGIN_M = 0.25  # the robot's radius
CAMERA_TOP_M = 1.0  # higher things neither block nor fill the view


def draw_world(axes: Axes, world: WorldFile) -> None:
    """Draw walls, furniture and grid, and set the limits."""
    everything, _ = expand(world)
    building = [*room_parts(world), *ground_parts(world)]
    for part in solids_between(building, *BODY_BAND_M):
        axes.add_patch(_outline(part, BORDER, zorder=3))
    for part in solids_between(everything[len(building) :], BODY_BAND_M[0], CAMERA_TOP_M):
        axes.add_patch(_outline(part, OBJECT, zorder=2))
    rects = world.rectangles()
    low = np.min([[x[0], y[0]] for x, y in rects], axis=0) - MARGIN_M
    high = np.max([[x[1], y[1]] for x, y in rects], axis=0) + MARGIN_M
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    grid_m = GRID_M if max(high - low) < WIDE_M else WIDE_GRID_M
    axes.set_xticks(_ticks(low[0], high[0], grid_m))
    axes.set_yticks(_ticks(low[1], high[1], grid_m))
    axes.set_xticklabels([f"{t:g}" if t == round(t) else "" for t in axes.get_xticks()])
    axes.set_yticklabels([f"{t:g}" if t == round(t) else "" for t in axes.get_yticks()])
    axes.grid(color="#dddddd", linewidth=0.5, zorder=0)
    axes.set_axisbelow(True)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


def _outline(part: Part, colour: str, zorder: int) -> Rectangle | Circle | Polygon:
    x, y = part.centre_m[:2]
    style = {"facecolor": colour, "edgecolor": colour, "linewidth": 0.8, "zorder": zorder}
    if part.shape == "cylinder":
        return Circle((x, y), part.size_m[0] / 2, **style)
    if part.shape == "hull":
        return Polygon(hull_corners_m(part), closed=True, **style)
    half = np.array(part.size_m[:2]) / 2
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
    c, s = np.cos(part.yaw_rad), np.sin(part.yaw_rad)
    return Polygon(corners @ np.array([[c, s], [-s, c]]) + (x, y), closed=True, **style)


def _ticks(low: float, high: float, grid_m: float) -> np.ndarray:
    return np.arange(np.ceil(low / grid_m), np.floor(high / grid_m) + 1) * grid_m
