"""Mean average precision over the level of each disturbance (thesis figures 3.2, 3.5, 3.7 and 3.9)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from experiments.work.page import SERIES, line_style, new_figure
from services.launcher.drawing.pictures import save_figure

LINES = {"equirectangular": "-", "tangent": "--"}
LABELS = {
    "latitude": "latitude of the picture's centre (deg)",
    "longitude": "longitude of the picture's centre (deg)",
    "blur": "blur (pixels)",
    "rotation": "rotation (deg)",
    "scale": "scale",
}


def draw_matching(path: Path, results: Sequence[dict[str, Any]], matcher: str) -> None:
    """One panel per disturbance; colour is the descriptor, a dashed line its tangent pictures.

    Args:
        path: PNG to write.
        results: rows of the study that were measured.
        matcher: whose rows are drawn.
    """
    shown = [row for row in results if row["matcher"] == matcher]
    kinds = [kind for kind in LABELS if any(row["disturbance"] == kind for row in shown)]
    if not kinds:
        return
    rows, columns = (len(kinds) + 2) // 3, min(3, len(kinds))
    figure = new_figure(4.6 * columns, 3.9 * rows)
    grid = figure.subplots(rows, columns, sharey=True, squeeze=False).ravel()
    descriptors = list(dict.fromkeys(row["descriptor"] for row in shown))
    for axes, kind in zip(grid, kinds, strict=False):
        for number, name in enumerate(descriptors):
            for representation, line in LINES.items():
                points = sorted(
                    (row["level"], row["map"])
                    for row in shown
                    if (row["disturbance"], row["descriptor"], row["representation"])
                    == (kind, name, representation)
                )
                label = f"{name}, {representation}"
                axes.plot(*zip(*points, strict=True), line, label=label, **line_style(number))
        axes.set(xlabel=LABELS[kind], ylim=(0.0, 1.0), xscale="log" if kind == "scale" else "linear")
        axes.grid(alpha=0.3)
    grid[0].set_ylabel("mean average precision")
    for axes in grid[len(kinds) :]:
        axes.axis("off")
    handles, labels = grid[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", fontsize=7)
    save_figure(figure, path)


def draw_curves(path: Path, curves: Sequence[tuple[str, Any]]) -> None:
    """Precision against recall as steps (figure 3.11)."""
    figure = new_figure(5.4, 4.2)
    axes = figure.subplots()
    for number, (name, curve) in enumerate(curves):
        axes.step(
            [0.0, *curve.recall],
            [curve.precision[0], *curve.precision],
            where="pre",
            color=SERIES[number % len(SERIES)],
            label=f"{name}: {curve.area:.2f}",
        )
    axes.set(xlabel="recall", ylabel="precision", xlim=(0, 1), ylim=(0, 1.03))
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    save_figure(figure, path)
