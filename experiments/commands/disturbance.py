"""`topnav study disturbance`: hide and seek on a clean map while camera and world are disturbed."""

from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

LEVELS = "0,0.33,0.66,1"
SHOWN = (
    "disturbance",
    "level",
    "success_rate",
    "spl_mean",
    "rounds",
    "final_distance_m_median",
    "collisions",
    "failures",
)


@app.command("disturbance")
@on_record("study disturbance")
def disturbance(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    only: Annotated[
        str | None, typer.Option(help='Disturbances to study, as "fog,noise"; default: all.')
    ] = None,
    levels: Annotated[str, typer.Option(help="Levels from 0 to 1; 0 is run once for all.")] = LEVELS,
    rounds: Annotated[int, typer.Option(min=1, help="Hiders to find at each level, the same at all.")] = 10,
    seed: options.Seed = 1,
    max_steps: options.MaxSteps = 1500,
    json_file: options.JsonFile = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the curves into this PNG.")] = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Success and SPL against the level of each disturbance; goes on where --json F stopped.

    The map must have been made in clean conditions. 0.5 is the middle level. Every level gets a stack of its
    own, and the same rounds from the same seeds.
    """
    from experiments.driving import disturbance as driven
    from experiments.work.results_file import ResultsFile
    from services.launcher.terminal.output import print_rows

    names, numbers = _names(only), _numbers(levels)
    study = driven.Study(world, map_name, rounds, seed, max_steps, data_dir)
    found = ResultsFile(json_file, study.setup())
    for setting in driven.settings_to_run(names, numbers, found.results):
        found.add(driven.run_level(study, setting["disturbance"], setting["level"]))
        if plot is not None:
            driven.draw_curves(plot, found.results)
    if plot is not None:
        driven.draw_curves(plot, found.results)
    print_rows(f"disturbances in {world}, seed {seed}", found.results, SHOWN)
    return len(found.results)


def _names(only: str | None) -> list[str]:
    from services.launcher.client.failure import ExperimentError
    from simulator.disturbances.levels import Disturbances

    known = list(Disturbances.model_fields)
    if only is None:
        return known
    names = [name.strip() for name in only.split(",") if name.strip()]
    if set(names) - set(known) or not names:
        raise ExperimentError(f"--only must name some of {', '.join(known)}; got {only!r}")
    return names


def _numbers(levels: str) -> list[float]:
    from services.launcher.client.failure import ExperimentError

    try:
        numbers = [float(level) for level in levels.split(",")]
    except ValueError as error:
        raise ExperimentError(f'--levels must be numbers as "{LEVELS}", got {levels!r}') from error
    if not all(0.0 <= number <= 1.0 for number in numbers):
        raise ExperimentError(f"--levels must lie from 0 to 1, got {levels!r}")
    return numbers
