"""Coverage over driven metres, as a picture."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from services.launcher.drawing.pictures import save_figure

LINES = ("#1f5fd0", "#d0701f", "#888888")
FINISHED = 0.97
"""Coverage at which a map is as good as finished."""


def draw_coverage(
    path: Path, title: str, curves: Mapping[str, Sequence[tuple[float, float]]], most_m: float | None = None
) -> None:
    """Draw driven metres and covered shares, with the line at which a map is as good as finished.

    Args:
        path: picture to write.
        title: of the picture.
        curves: driven metres with the covered share by name, at most as many as there are colours.
        most_m: metres at the right border; None shows all.
    """
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for (name, curve), colour in zip(curves.items(), LINES, strict=False):
        metres, covered = zip(*curve, strict=True) if curve else ((), ())
        axes.step(metres, [100.0 * share for share in covered], where="post", color=colour, label=name)
    if len(curves) > 1:
        axes.legend(loc="lower right")
    axes.axhline(100.0 * FINISHED, color="#999999", linewidth=0.8)
    axes.set(xlabel="driven (m)", ylabel="covered (%)", ylim=(0.0, 102.0), title=title)
    axes.set_xlim(0.0, most_m)
    axes.grid(visible=True, alpha=0.3)
    save_figure(figure, path)
