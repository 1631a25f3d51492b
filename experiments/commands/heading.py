"""`topnav study heading`: the Monte Carlo comparison of the heading methods (thesis 3.2), and more."""

import math
from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

PARTS = ("ahae", "dcpe", "noise", "sweep", "examples")
PER_DEGREE = math.degrees(1.0)
"""The gain of exp when its argument is in degrees, per radian."""


@app.command("heading")
@on_record("study heading")
def heading(
    quick: Annotated[bool, typer.Option("--quick", help="A glimpse in less than a minute.")] = False,
    full: Annotated[bool, typer.Option("--full", help="The thesis's 100 scenes of 2000 runs.")] = False,
    only: Annotated[str | None, typer.Option(help=f'Parts, as "ahae,dcpe"; of {", ".join(PARTS)}.')] = None,
    gain: Annotated[
        float, typer.Option(min=0.01, help="Of exp in methods 2, 4, 5 and 6, per radian; 57.3 is per degree.")
    ] = PER_DEGREE,
    device: Annotated[str, typer.Option(help="Where paths are tracked: cpu or cuda.")] = "cpu",
    cluster: Annotated[str | None, typer.Option(help="Dask scheduler, for example tcp://host:8786.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; default: all cores.")] = None,
    plots: Annotated[Path | None, typer.Option(help="Draw the figures into this folder.")] = None,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Heading errors (AHAE) and detours (DCPE) of all methods in random scenes.

    Finished scenes are kept: a study cut off goes on where it was.
    """
    from functools import partial

    from experiments.monte_carlo import report, study
    from experiments.work.workers import results_of
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import wide_console, write_json

    if quick and full:
        raise ExperimentError("--quick and --full exclude each other: choose one")
    if device not in ("cpu", "cuda"):
        raise ExperimentError(f"--device must be cpu or cuda, got {device!r}")
    asked = PARTS if only is None else tuple(part.strip() for part in only.split(","))
    if wrong := sorted(set(asked) - set(PARTS)):
        raise ExperimentError(f"--only knows {', '.join(PARTS)}, got {', '.join(wrong)}")
    size = study.QUICK if quick else study.FULL if full else study.NORMAL
    work = partial(
        results_of,
        folder=data_dir / "studies" / "heading",
        console=wide_console(stderr=True),
        cluster=cluster,
        jobs=jobs,
    )
    found, measured = report.measure(asked, size, seed, work, gain, device)
    if plots is not None:
        report.draw(plots, found, measured, with_examples="examples" in asked)
    write_json(json_file, found)
    report.show(found)
    return sum(len(rows) for rows in found.values() if isinstance(rows, list))
