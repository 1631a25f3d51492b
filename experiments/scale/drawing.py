"""How the cost of a map grows with its nodes, and what robots wait for when they become more."""

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes

from experiments.work.page import new_figure
from services.launcher.drawing.pictures import save_figure

CURVES = (
    ("exhaustive_ms", "all nodes, verified", "o"),
    ("localise_p99_ms", "topnav, 99th percentile", "v"),
    ("localise_p50_ms", "topnav, median", "s"),
    ("track_p50_ms", "on a way, median", "^"),
)


def draw_growth(path: Path, points: list[dict[str, Any]], robots: list[dict[str, Any]]) -> None:
    """Draw times, loading and memory of maps above; waiting and frames of robots below."""
    figure = new_figure(10.0, 8.4)
    (finding, keeping), (waiting, throughput) = figure.subplots(2, 2)
    for key, label, marker in CURVES:
        rows = [row for row in points if row[key] is not None]
        finding.plot([row["nodes"] for row in rows], [row[key] for row in rows], marker=marker, label=label)
    finding.set(xlabel="nodes in the map", ylabel="time per picture (ms)", title="finding a node")
    nodes = [row["nodes"] for row in points]
    keeping.plot(nodes, [row["load_s"] for row in points], marker="o", label="taking over (s)")
    megabytes = [row["nodes"] * row["bytes_per_node"] / 1e6 for row in points]
    keeping.plot(nodes, megabytes, marker="s", label="kept features (MB)")
    keeping.set(xlabel="nodes in the map", title="keeping a map")
    _draw_robots(waiting, throughput, robots)
    for axes in (finding, keeping):
        axes.set(xscale="log", yscale="log")
    for axes in (waiting, throughput):
        axes.set_xscale("log", base=2)
        axes.xaxis.set_major_formatter("{x:.0f}")
        axes.set_ylim(bottom=0.0)
    for axes in (finding, keeping, waiting, throughput):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    save_figure(figure, path)


def _draw_robots(waiting: Axes, throughput: Axes, rows: list[dict[str, Any]]) -> None:
    """One colour for each number of services; robots that ask without a pause are dashed on the right."""
    for colour, services in enumerate(sorted({row["services"] for row in rows})):
        name = f"{services} feature service" + ("s" if services > 1 else "")
        for rate_hz in sorted({row["rate_hz"] for row in rows}, reverse=True):
            of = [row for row in rows if (row["services"], row["rate_hz"]) == (services, rate_hz)]
            count, style = [row["robots"] for row in of], "-" if rate_hz else "--"
            how = f"{rate_hz:g} frames/s each" if rate_hz else "without a pause"
            given: dict[str, Any] = {
                "color": f"C{colour}",
                "marker": "o",
                "linestyle": style,
                "label": f"{name}, {how}",
            }
            throughput.plot(count, [row["frames_per_s"] for row in of], **given)
            if rate_hz:
                waiting.plot(count, [row["p50_ms"] for row in of], **given | {"label": f"{name}, median"})
                p99 = given | {"label": f"{name}, 99th percentile", "linestyle": ":", "marker": "v"}
                waiting.plot(count, [row["p99_ms"] for row in of], **p99)
                waiting.set_xlabel(f"robots, {rate_hz:g} frames/s each at most")
    waiting.set(ylabel="frame to answer (ms)", title="waiting")
    throughput.set(xlabel="robots", ylabel="frames/s of all together", title="answers")
