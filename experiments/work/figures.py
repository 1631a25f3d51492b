"""How the figures of all studies look."""

from typing import Any

from matplotlib.figure import Figure

SERIES = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000")
"""Colours that stay apart for colour-blind readers (Okabe and Ito 2008)."""

MARKERS = "osD^vP*<>"


def new_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure that makes room for its labels by itself."""
    return Figure(figsize=(width_in, height_in), layout="constrained")


def line_style(number: int) -> dict[str, Any]:
    """Colour and marker of the curve with this number; 63 differ."""
    colour, marker = SERIES[number % len(SERIES)], MARKERS[number % len(MARKERS)]
    return {"color": colour, "marker": marker, "markersize": 4}
