"""Curves of success and SPL over the level of each disturbance."""

from pathlib import Path
from typing import Any

from experiments.work.figures import line_style, new_figure
from services.launcher.drawing.pictures import save_figure

MEASURES = (("success_rate", "success rate"), ("spl_mean", "mean SPL"))


def draw_curves(path: Path, results: list[dict[str, Any]], clean: str) -> None:
    """Draw one curve per disturbance in both measures; the clean result is the start of all of them.

    Args:
        path: PNG to write.
        results: entries with disturbance, level, success_rate and spl_mean.
        clean: name of the entry without any disturbance.
    """
    figure = new_figure(10.0, 4.4)
    start = [row for row in results if row["disturbance"] == clean]
    names = list(dict.fromkeys(row["disturbance"] for row in results if row["disturbance"] != clean))
    for axes, (key, title) in zip(figure.subplots(1, 2, sharey=True), MEASURES, strict=True):
        for number, name in enumerate(names):
            rows = sorted(
                [*start, *(r for r in results if r["disturbance"] == name)], key=lambda row: row["level"]
            )
            levels = [row["level"] for row in rows]
            axes.plot(levels, [row[key] for row in rows], label=name, **line_style(number))
        if not names:
            axes.plot([0.0] * len(start), [row[key] for row in start], "ko", label=clean)
        axes.axhline(0.9, color="0.7", linestyle=":") if key == "success_rate" else None
        axes.set(xlabel="level", title=title, xlim=(-0.03, 1.03), ylim=(-0.03, 1.05))
        axes.grid(alpha=0.3)
    figure.axes[1].legend(loc="lower left", fontsize=8)
    save_figure(figure, path)
