"""Error histograms of the tours and the reliability diagram."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from experiments.photographs.study import Found
from experiments.photographs.tables import RIGHT_DEG, calibration
from experiments.work.page import SERIES, new_figure
from services.launcher.drawing.pictures import save_figure

BIN_DEG = 10.0
COLUMNS = 3
TOURS_MOST = 11
"""Panels of single tours: with more nobody reads them, and the one of all tours tells the same."""


def draw(path: Path, found: Found) -> None:
    """One panel of errors for each tour and one for all of them, and the reliability of confidence."""
    panels = [(one.tour.file.name, one.links) for one in found.tours]
    panels = ([] if len(panels) == 1 else panels[:TOURS_MOST]) + [("all tours", found.links)]
    rows = (len(panels) + COLUMNS) // COLUMNS  # one panel more, for reliability
    figure = new_figure(4.2 * COLUMNS, 3.2 * rows)
    grid = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    for axes, (name, links) in zip(grid, panels, strict=False):
        offs = [link.off_deg for link in links]
        _errors(axes, name, [off for off in offs if off is not None], len(offs))
    _reliability(grid[len(panels)], calibration(found.links))
    for axes in grid[len(panels) + 1 :]:
        axes.axis("off")
    save_figure(figure, path)


def _errors(axes: Any, name: str, errors_deg: Sequence[float], links: int) -> None:
    """Counts of errors, those that are right in another colour."""
    edges = np.arange(0.0, 180.0 + BIN_DEG, BIN_DEG)
    counts, _ = np.histogram(errors_deg, edges)
    colours = [SERIES[2] if edge < RIGHT_DEG else SERIES[3] for edge in edges[:-1]]
    axes.bar(edges[:-1], counts, BIN_DEG, align="edge", color=colours, edgecolor="white", linewidth=0.5)
    axes.set(xlabel="heading off by (deg)", ylabel="links", xlim=(0.0, 180.0))
    axes.set_xticks(range(0, 181, 30))
    axes.yaxis.get_major_locator().set_params(integer=True)
    axes.set_title(f"{name}: {len(errors_deg)} of {links} links answered", fontsize=9)


def _reliability(axes: Any, figures: Mapping[str, Any]) -> None:
    """Share of right answers against confidence; the area of a point grows with its answers."""
    bins = figures["bins"]
    axes.plot((0, 1), (0, 1), color="0.7", linewidth=1)
    most = max((one["n"] for one in bins), default=1)
    axes.scatter(
        [one["confidence"] for one in bins],
        [one["right"] for one in bins],
        s=[30 + 270 * one["n"] / most for one in bins],
        color=SERIES[0],
        alpha=0.7,
    )
    for one in bins:
        axes.annotate(str(one["n"]), (one["confidence"], one["right"]), fontsize=7, ha="center", va="center")
    axes.set(
        xlabel="confidence", ylabel=f"share within {RIGHT_DEG:g} deg", xlim=(-0.05, 1.05), ylim=(-0.05, 1.05)
    )
    axes.grid(alpha=0.3)
    ece = figures["ece"]
    axes.set_title(
        "reliability, numbers are answers" + (f"; error {ece:.2f}" if ece is not None else ""), fontsize=9
    )
