"""How the cost of a map grows with its places."""

from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from experiments.plots.saving import save

SIZE_IN = (10.0, 4.4)
CURVES = (
    ("exhaustive_ms", "all places, verified", "o"),
    ("localise_p99_ms", "topnav, 99th percentile", "v"),
    ("localise_p50_ms", "topnav, median", "s"),
    ("track_p50_ms", "on a way, median", "^"),
)


def draw_growth(path: Path, points: list[dict[str, Any]]) -> None:
    """Draw times on the left, loading and memory on the right, both axes logarithmic."""
    figure = Figure(figsize=SIZE_IN, layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    for key, label, marker in CURVES:
        rows = [row for row in points if row[key] is not None]
        left.plot([row["nodes"] for row in rows], [row[key] for row in rows], marker=marker, label=label)
    left.set(xlabel="places in the map", ylabel="time per picture (ms)", title="finding a place")
    nodes = [row["nodes"] for row in points]
    right.plot(nodes, [row["load_s"] for row in points], marker="o", label="taking over (s)")
    megabytes = [row["nodes"] * row["bytes_per_node"] / 1e6 for row in points]
    right.plot(nodes, megabytes, marker="s", label="kept words (MB)")
    right.set(xlabel="places in the map", title="keeping a map")
    for axes in (left, right):
        axes.set(xscale="log", yscale="log")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    save(figure, path)
