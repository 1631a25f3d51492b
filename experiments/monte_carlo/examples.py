"""Single scenes that show what misleads a method (thesis figures 3.14, 3.15, 3.50, 3.67 and 3.68)."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from torch import Tensor

from experiments.monte_carlo.ahae import DEG
from experiments.monte_carlo.batched import batch_headings
from experiments.monte_carlo.scene import (
    SIDE_M,
    MonteCarloScene,
    Placement,
    draw_choices,
    draw_scene,
    lonlat_from,
)
from experiments.monte_carlo.tracking import STEP_M, follow
from experiments.work.page import SERIES, new_figure
from services.launcher.drawing.pictures import save_figure
from services.planner.heading.votes import latitude_votes, pair_votes
from shared.geometry.sphere import FloatArray, wrap_rad

COUNT, FEW = 150, 34
"""Matches of a picture of votes, and of a path: the most, and the middle, of the thesis's series."""

TRIES, FAR_M = 200, 4.0
"""Scenes looked at for a path that does not arrive, of those with a way worth drawing."""


def draw_pair_cloud(path: Path, placement: Placement, seed: int) -> None:
    """How far bisectors point astray against how much their pairs spread (figure 3.14)."""
    scene, points = _scene_and_points(placement, seed, COUNT)
    votes = pair_votes(lonlat_from(scene.current, points), lonlat_from(scene.target, points))
    growth_deg, error_deg = np.rad2deg(votes.growth_rad), np.rad2deg(_astray_rad(scene, votes.directions))
    figure = new_figure(6.0, 4.2)
    axes = figure.subplots()
    axes.plot(growth_deg, error_deg, ".", markersize=1.5, color=SERIES[0], alpha=0.5)
    edges = np.linspace(growth_deg.min(), growth_deg.max(), 16)
    bins = np.digitize(growth_deg, edges[1:-1])
    medians = [np.median(error_deg[bins == k]) if (bins == k).any() else np.nan for k in range(15)]
    axes.plot((edges[:-1] + edges[1:]) / 2, medians, "o-", color=SERIES[3], label="median")
    axes.set(
        xlabel="growth of the pair's longitude difference (deg)",
        ylabel="bisector away from the true heading (deg)",
    )
    axes.legend()
    save_figure(figure, path)


def draw_latitude_case(path: Path, placement: Placement, seed: int) -> None:
    """Matches that vote backwards: their latitude shrinks though the way leads past them (figure 3.15)."""
    scene, points = _scene_and_points(placement, seed, COUNT)
    votes = latitude_votes(lonlat_from(scene.current, points), lonlat_from(scene.target, points))
    backwards = _astray_rad(scene, votes.directions) > np.pi / 2
    figure = new_figure(5.2, 5.2)
    axes = figure.subplots()
    _draw_ends(axes, scene)
    for mask, colour, name in ((~backwards, SERIES[2], "forwards"), (backwards, SERIES[3], "backwards")):
        axes.plot(points[mask, 0], points[mask, 1], ".", color=colour, label=f"vote {name}")
    axes.legend(fontsize=8)
    save_figure(figure, path)


def draw_failed_path(path: Path, method: str, placement: Placement, seed: int) -> None:
    """A path that takes twice the straight way, its end enlarged, and its headings (3.50, 3.67 and 3.68).

    Nothing is drawn where none of the tries fails.
    """
    for number in range(TRIES):
        scene, points = _scene_and_points(placement, seed + number, FEW)
        headings: list[float] = []

        def steer(current: Tensor, target: Tensor, into: list[float] = headings) -> Tensor:
            heading = batch_headings(method, current, target, DEG)
            into.append(float(heading))
            return heading

        if scene.distance_m > FAR_M and follow(scene, points[None], steer)[0] >= 100.0:
            title = f"method {method}, target in the {placement.replace('_', '-')}"
            _draw_path(path, title, scene, points, np.array(headings))
            return


def _draw_path(path: Path, title: str, scene: MonteCarloScene, points: FloatArray, rad: FloatArray) -> None:
    steps = STEP_M * np.stack([np.cos(rad), np.sin(rad)], axis=1)
    way = np.concatenate([scene.current[None], scene.current + np.cumsum(steps, axis=0)])
    figure = new_figure(13.0, 4.4)
    whole, near, headings = figure.subplots(1, 3)
    for axes in (whole, near):
        _draw_ends(axes, scene)
        axes.plot(points[:, 0], points[:, 1], ".", color=SERIES[2], label="matches")
        axes.plot(*way.T, "-", color=SERIES[1], linewidth=1.2, label="path")
    reach_m = max(SIDE_M / 2, float(np.abs(way).max())) + 0.5
    whole.set(xlim=(-reach_m, reach_m), ylim=(-reach_m, reach_m), title=title)
    tail = way[-30:]
    (x, y), reach = tail.mean(axis=0), max(1.0, float(np.ptp(tail, axis=0).max()))
    near.set(xlim=(x - reach, x + reach), ylim=(y - reach, y + reach), title="its end")
    whole.legend(fontsize=8)
    headings.plot(np.rad2deg(rad), ".-", color=SERIES[0], markersize=3, linewidth=0.6)
    true_deg = np.rad2deg(scene.heading_rad)
    headings.axhline(true_deg, color="0.4", linestyle=":", label="true, at the start")
    headings.set(xlabel="step", ylabel="heading (deg)", title="heading")
    headings.legend(fontsize=8)
    save_figure(figure, path)


def _astray_rad(scene: MonteCarloScene, directions: FloatArray) -> FloatArray:
    """How far votes (N, 2) point away from the true heading."""
    return np.abs(wrap_rad(np.arctan2(directions[:, 1], directions[:, 0]) - scene.heading_rad))


def _draw_ends(axes: Axes, scene: MonteCarloScene) -> None:
    axes.plot(*scene.current, "P", color=SERIES[0], markersize=9, label="start")
    axes.plot(*scene.target, "*", color=SERIES[4], markersize=12, label="target")
    axes.set(xlabel="east (m)", ylabel="north (m)", aspect="equal")
    axes.set(xlim=(-SIDE_M / 2 - 0.5, SIDE_M / 2 + 0.5), ylim=(-SIDE_M / 2 - 0.5, SIDE_M / 2 + 0.5))
    axes.grid(alpha=0.3)


def _scene_and_points(placement: Placement, seed: int, count: int) -> tuple[MonteCarloScene, FloatArray]:
    rng = np.random.default_rng(seed)
    scene = draw_scene(placement, rng)
    return scene, scene.points[draw_choices(1, count, len(scene.points), rng)[0]]
