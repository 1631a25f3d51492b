"""`topnav study latency`: hide and seek with a camera whose frames come late."""

from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

LATENCIES = "0,150,300,450,600"
SHOWN = (
    "latency_ms",
    "rate_hz",
    "success_rate",
    "spl_mean",
    "final_distance_median_m",
    "collisions",
    "speed_mean_mps",
)


@app.command("latency")
@on_record("study latency")
def latency(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    latencies: Annotated[str, typer.Option(help="From exposure to arrival, whole ms, 0 to 600.")] = LATENCIES,
    rate_hz: Annotated[float, typer.Option(min=1.0, max=30.0, help="Frames a second.")] = 5.0,
    rounds: Annotated[int, typer.Option(min=1, help="Hiders to find at each delay, the same at all.")] = 20,
    seed: options.Seed = 1,
    max_steps: options.MaxSteps = 1500,
    json_file: options.JsonFile = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the curves into this PNG.")] = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Success, SPL and speed against the delay of the camera; goes on where --json F stopped.

    The map must be there. Every delay gets a stack of its own, and the same rounds from the same seeds.
    """
    from experiments.driving import latency as driven
    from experiments.driving.disturbance import Study
    from experiments.work.results_file import ResultsFile
    from services.launcher.terminal.output import print_rows

    wanted = _milliseconds(latencies)
    study = Study(world, map_name, rounds, seed, max_steps, data_dir)
    found = ResultsFile(json_file, study.setup(), main="points")
    done = {(row["latency_ms"], row["rate_hz"]) for row in found.results}
    for latency_ms in (one for one in wanted if (one, rate_hz) not in done):
        found.add(driven.run_point(study, latency_ms, rate_hz))
        if plot is not None:
            driven.draw_points(plot, found.results)
    if plot is not None:
        driven.draw_points(plot, found.results)
    print_rows(f"late frames in {world}, seed {seed}", found.results, SHOWN)
    return len(found.results)


def _milliseconds(text: str) -> list[int]:
    from services.launcher.client.failure import ExperimentError
    from simulator.disturbances.transit import MOST_S

    most_ms = round(1000.0 * MOST_S)
    try:
        numbers = [int(one) for one in text.split(",")]
    except ValueError as error:
        raise ExperimentError(
            f'--latencies must be whole milliseconds as "{LATENCIES}", got {text!r}'
        ) from error
    if not all(0 <= number <= most_ms for number in numbers):
        raise ExperimentError(f"--latencies must lie from 0 to {most_ms} ms, got {text!r}")
    return sorted(set(numbers))
