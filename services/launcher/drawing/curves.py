"""Coverage over driven metres, as a picture."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from services.launcher.drawing.pictures import save_figure

LINE = "#1f5fd0"
FINISHED = 0.97
"""Coverage at which a map is as good as finished."""


def draw_coverage(path: Path, title: str, curve: Sequence[tuple[float, float]]) -> None:
    """Draw driven metres and covered shares, with the line at which a map is as good as finished."""
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    axes = figure.add_subplot()
    metres, covered = zip(*curve, strict=True) if curve else ((), ())
    axes.step(metres, [100.0 * share for share in covered], where="post", color=LINE)
    axes.axhline(100.0 * FINISHED, color="#999999", linewidth=0.8)
    axes.set(xlabel="driven (m)", ylabel="covered (%)", ylim=(0.0, 102.0), title=title)
    axes.set_xlim(left=0.0)
    axes.grid(visible=True, alpha=0.3)
    save_figure(figure, path)
