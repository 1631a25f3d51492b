"""Error histograms of the tours and the reliability diagram."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from experiments.photographs.study import Found
from experiments.photographs.tables import calibration
from experiments.work.page import SERIES, new_figure
from experiments.work.reliability import RIGHT_DEG, draw_reliability
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
    draw_reliability(grid[len(panels)], calibration(found.links))
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
