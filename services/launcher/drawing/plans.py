"""Map and way on the plan of a world, in the thesis's colours.

Blue nodes and edges, green start, purple via points, red target, orange way.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from services.launcher.drawing.pictures import save_figure
from services.launcher.drawing.world import draw_world
from shared.messages.maps import Edge
from shared.messages.simulation import Pose
from simulator.world.world_file import WorldFile

NODE = "#1f5fd0"
EDGE = "#7fa8ea"
START = "#1a9a3c"
VIA = "#8a2be2"
TARGET = "#d62020"
PATH = "#ff8c00"
SIZE_IN = (7.5, 8.5)  # a page's width, with room for the legend above
LABELLED = 150  # nodes: with more, their numbers cover one another


@dataclass(frozen=True)
class Way:
    """A way to a goal.

    Attributes:
        points_m: true positions of the robot.
        via: node ids of the plan; the goal itself (-1) is left out.
    """

    points_m: tuple[tuple[float, float], ...]
    start: Pose
    goal: Pose
    via: tuple[int, ...]


def draw_start(path: Path, world: WorldFile) -> None:
    """Draw a world alone, and where the robot starts in it."""
    figure, axes = _sheet(world)
    axes.plot([world.start.x_m], [world.start.y_m], "o", color=START)
    axes.set_title(f"{world.name}, start in green")
    save_figure(figure, path)


def draw_map(path: Path, world: WorldFile, poses: Mapping[int, Pose], edges: Iterable[Edge]) -> None:
    """Draw the nodes and edges of a map at their true poses."""
    figure, axes = _sheet(world)
    _graph(axes, poses, edges)
    axes.set_title(f"map of {world.name}: {len(poses)} nodes")
    save_figure(figure, path)


def draw_way(
    path: Path, world: WorldFile, poses: Mapping[int, Pose], edges: Iterable[Edge], way: Way
) -> None:
    """Draw a way over the map it was planned in."""
    figure, axes = _sheet(world)
    _graph(axes, poses, edges)
    xs, ys = zip(*way.points_m, strict=True) if way.points_m else ((), ())
    axes.plot(xs, ys, color=PATH, linewidth=2.0, zorder=8)
    for node in way.via:
        if node in poses:
            _spot(axes, poses[node], VIA, 45, 9)
    _spot(axes, way.start, START, 90, 10)
    _spot(axes, way.goal, TARGET, 90, 10)
    named = (("start", START), ("via points", VIA), ("target", TARGET))
    handles = [Line2D([], [], color=c, marker="o", linestyle="", label=name) for name, c in named]
    handles.append(Line2D([], [], color=PATH, label="way driven"))
    axes.legend(handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, fontsize=8)
    save_figure(figure, path)


def _sheet(world: WorldFile) -> tuple[Figure, Axes]:
    figure = Figure(figsize=SIZE_IN, layout="constrained")
    axes = figure.add_subplot()
    draw_world(axes, world)
    return figure, axes


def _graph(axes: Axes, poses: Mapping[int, Pose], edges: Iterable[Edge]) -> None:
    for edge in edges:
        if edge.a in poses and edge.b in poses:
            a, b = poses[edge.a], poses[edge.b]
            axes.plot((a.x_m, b.x_m), (a.y_m, b.y_m), color=EDGE, linewidth=0.7, alpha=0.7, zorder=4)
    for node, pose in poses.items():
        _spot(axes, pose, NODE, 22, 6)
        if len(poses) <= LABELLED:
            axes.annotate(
                str(node), (pose.x_m, pose.y_m), (2, 2), textcoords="offset points", fontsize=5, zorder=7
            )


def _spot(axes: Axes, pose: Pose, colour: str, size: float, zorder: int) -> None:
    axes.scatter(
        [pose.x_m], [pose.y_m], s=size, color=colour, edgecolors="white", linewidths=0.5, zorder=zorder
    )
