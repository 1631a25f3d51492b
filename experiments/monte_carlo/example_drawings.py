"""Single Monte Carlo scenes: what misleads a method (thesis figures 3.14, 3.15, 3.50, 3.67, 3.68)."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from experiments.monte_carlo.examples import FailedPath, LatitudeCase, PairCloud
from experiments.monte_carlo.scene import SIDE_M, MonteCarloScene
from experiments.work.figures import SERIES, new_figure
from services.launcher.drawing.pictures import save_figure


def draw_pair_cloud(path: Path, cloud: PairCloud) -> None:
    """How far bisectors point astray against how much their pairs spread (figure 3.14)."""
    figure = new_figure(6.0, 4.2)
    axes = figure.subplots()
    axes.plot(cloud.growth_deg, cloud.error_deg, ".", markersize=1.5, color=SERIES[0], alpha=0.5)
    edges = np.linspace(cloud.growth_deg.min(), cloud.growth_deg.max(), 16)
    place = np.digitize(cloud.growth_deg, edges[1:-1])
    medians = [np.median(cloud.error_deg[place == k]) if (place == k).any() else np.nan for k in range(15)]
    axes.plot((edges[:-1] + edges[1:]) / 2, medians, "o-", color=SERIES[3], label="median")
    axes.set(
        xlabel="growth of the pair's longitude difference (deg)",
        ylabel="bisector away from the true heading (deg)",
    )
    axes.legend()
    save_figure(figure, path)


def draw_latitude_case(path: Path, case: LatitudeCase) -> None:
    """Which matches vote backwards (figure 3.15)."""
    figure = new_figure(5.2, 5.2)
    axes = figure.subplots()
    points = case.scene.points[case.chosen]
    _spots(axes, case.scene)
    for mask, colour, name in (
        (~case.astray, SERIES[2], "vote forwards"),
        (case.astray, SERIES[3], "vote backwards"),
    ):
        axes.plot(points[mask, 0], points[mask, 1], ".", color=colour, label=name)
    axes.legend(fontsize=8)
    save_figure(figure, path)


def draw_failed_path(path: Path, failed: FailedPath, title: str) -> None:
    """A path that does not arrive, its last part enlarged, and its headings (figures 3.50, 3.67 and 3.68)."""
    figure = new_figure(13.0, 4.4)
    whole, near, headings = figure.subplots(1, 3)
    points = failed.scene.points[failed.chosen]
    for axes in (whole, near):
        _spots(axes, failed.scene)
        axes.plot(points[:, 0], points[:, 1], ".", color=SERIES[2], label="matches")
        axes.plot(*failed.path.T, "-", color=SERIES[1], linewidth=1.2, label="path")
    reach_m = max(SIDE_M / 2, float(np.abs(failed.path).max())) + 0.5
    whole.set(xlim=(-reach_m, reach_m), ylim=(-reach_m, reach_m))
    tail = failed.path[-30:]
    middle, reach = tail.mean(axis=0), max(1.0, float(np.ptp(tail, axis=0).max()))
    near.set(
        xlim=(middle[0] - reach, middle[0] + reach),
        ylim=(middle[1] - reach, middle[1] + reach),
        title="its end",
    )
    whole.legend(fontsize=8)
    whole.set_title(title)
    headings.plot(np.rad2deg(failed.heading_rad), ".-", color=SERIES[0], markersize=3, linewidth=0.6)
    headings.axhline(
        np.rad2deg(failed.scene.heading_rad), color="0.4", linestyle=":", label="true, at the start"
    )
    headings.set(xlabel="step", ylabel="heading (deg)", title="heading")
    headings.legend(fontsize=8)
    save_figure(figure, path)


def _spots(axes: Axes, scene: MonteCarloScene) -> None:
    axes.plot(*scene.current, "P", color=SERIES[0], markersize=9, label="start")
    axes.plot(*scene.target, "*", color=SERIES[4], markersize=12, label="target")
    axes.set(xlabel="east (m)", ylabel="north (m)", aspect="equal")
    axes.set(xlim=(-SIDE_M / 2 - 0.5, SIDE_M / 2 + 0.5), ylim=(-SIDE_M / 2 - 0.5, SIDE_M / 2 + 0.5))
    axes.grid(alpha=0.3)
