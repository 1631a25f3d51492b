"""Box plots per method and comparisons over the number of matches (thesis figures 3.16 to 3.66)."""

from pathlib import Path

from matplotlib.axes import Axes

from experiments.monte_carlo.ahae import METHODS, Statistics
from experiments.work.page import line_style, new_figure
from services.launcher.drawing.pictures import save_figure
from shared.geometry.sphere import FloatArray


def draw_boxes(path: Path, title: str, unit: str, figures: Statistics) -> None:
    """One column per method; above the standard deviations of all scenes, below their means.

    Boxes are quartiles, the orange line is the median, the dashed blue line joins the means.

    Args:
        path: PNG to write.
        title: of the figure.
        unit: of the values.
        figures: of one placement.
    """
    figure = new_figure(3.0 * len(METHODS), 5.6)
    grid = figure.subplots(2, len(METHODS), sharex=True, sharey="row", squeeze=False)
    for column, method in enumerate(METHODS):
        for axes, values in zip(grid[:, column], (figures.stds, figures.means), strict=True):
            _box(axes, values[:, column])
        grid[0, column].set_title(f"method {method}")
        grid[1, column].set_xticks(range(1, len(figures.counts) + 1), [str(n) for n in figures.counts])
        grid[1, column].set_xlabel("matches")
    for row, values in zip(grid, (figures.stds, figures.means), strict=True):
        row[0].set_ylim(0.0, 1.05 * float(values.max()))
    grid[0, 0].set_ylabel(f"standard deviation per scene ({unit})")
    grid[1, 0].set_ylabel(f"mean per scene ({unit})")
    figure.suptitle(title)
    save_figure(figure, path)


def draw_comparison(path: Path, title: str, unit: str, figures: Statistics) -> None:
    """Mean and spread over the scenes of both the standard deviations and the means, one line per method."""
    figure = new_figure(10.0, 6.4)
    grid = figure.subplots(2, 2, sharex=True)
    for column, (values, name) in enumerate(
        ((figures.stds, "standard deviations"), (figures.means, "means"))
    ):
        for row, (lines, what) in enumerate(((values.mean(axis=0), "mean"), (values.std(axis=0), "spread"))):
            axes = grid[row, column]
            for number, method in enumerate(METHODS):
                axes.plot(figures.counts, lines[number], label=f"method {method}", **line_style(number))
            axes.set(title=f"{what} of the scenes' {name}", ylabel=unit, xscale="log", ylim=(0, None))
            axes.set_xticks(list(figures.counts), [str(n) for n in figures.counts])
            axes.minorticks_off()
            axes.grid(alpha=0.3)
    for axes in grid[1]:
        axes.set_xlabel("matches")
    grid[0, 1].legend(fontsize=8)
    figure.suptitle(title)
    save_figure(figure, path)


def _box(axes: Axes, values: FloatArray) -> None:
    axes.boxplot(
        values,
        widths=0.6,
        medianprops={"color": "#E69F00"},
        flierprops={"markersize": 2, "markeredgecolor": "0.5"},
    )
    axes.plot(range(1, values.shape[1] + 1), values.mean(axis=0), "--", color="#0072B2", linewidth=1.2)
    axes.grid(axis="y", alpha=0.3)
