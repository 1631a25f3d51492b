"""Hide and seek with a camera whose frames come late: the rounds at one delay."""

from pathlib import Path

from experiments.driving.disturbance import Study, play
from experiments.hide_and_seek.report import summary
from experiments.work.page import new_figure
from experiments.work.results_file import Row
from services.launcher.drawing.pictures import save_figure
from services.launcher.terminal.output import rounded
from simulator.disturbances.levels import Disturbances
from simulator.disturbances.transit import MOST_S

MEASURES = (
    ("success_rate", "success rate"),
    ("spl_mean", "mean SPL"),
    ("speed_mean_mps", "mean speed (m/s)"),
    ("final_distance_median_m", "median distance left (m)"),
)


def run_point(study: Study, latency_ms: int, rate_hz: float) -> Row:
    """Start a stack whose frames come so late and so often, and play the rounds."""
    levels = Disturbances(latency=0.001 * latency_ms / MOST_S)
    environment = {"SIMULATOR_CONTROL_PERIOD_S": f"{1.0 / rate_hz:.4g}"}
    rounds = play(study, f"{latency_ms} ms, {rate_hz:g} Hz", levels, environment)
    whole = summary(rounds)
    driven_m = sum(float(one["driven_m"]) for one in rounds)
    duration_s = sum(int(one["steps"]) for one in rounds) / rate_hz
    kept = ("success_rate", "spl_mean", "final_distance_median_m", "collisions", "wrong_place")
    return {
        "latency_ms": latency_ms,
        "rate_hz": rate_hz,
        **{name: whole[name] for name in kept},
        "speed_mean_mps": rounded(driven_m / max(duration_s, 1e-9), 3),
        "each": rounds,
    }


def draw_points(path: Path, points: list[Row]) -> None:
    """Draw each measure over the delay, one line for each rate.

    Args:
        path: PNG to write.
        points: as `run_point` returns them.
    """
    figure = new_figure(10.0, 6.4)
    for axes, (key, title) in zip(figure.subplots(2, 2).flat, MEASURES, strict=True):
        for rate_hz in sorted({one["rate_hz"] for one in points}):
            line = sorted((one["latency_ms"], one[key]) for one in points if one["rate_hz"] == rate_hz)
            axes.plot(*zip(*line, strict=True), marker="o", label=f"{rate_hz:g} Hz")
        axes.set(xlabel="latency (ms)", title=title)
        axes.set_ylim(0.0, 1.05 if key in {"success_rate", "spl_mean"} else None)
        axes.grid(alpha=0.3)
    figure.axes[0].legend(loc="lower left", fontsize=8)
    save_figure(figure, path)
