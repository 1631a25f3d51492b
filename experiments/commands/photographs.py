"""`topnav study photographs`: what a pipeline makes of 360-degree pictures of a real place."""

import os
from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("photographs")
@on_record("study photographs")
def photographs(
    tours: Annotated[
        Path | None, typer.Option(help="Folder of tours: each has a tour.json beside its pictures.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Few tilted pictures and foreign pairs.")] = False,
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; default: one for each core.")] = None,
    profile: options.ProfileName = None,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,  # noqa: ARG001 - the record of the run goes there
) -> int:
    """Headings, edges and recognition on linked pictures whose bearings are known; deploy/PHOTOGRAPHS.md."""
    from experiments.photographs.eyes import eyes
    from experiments.photographs.report import show
    from experiments.photographs.study import measure, report
    from experiments.photographs.tours import read_tours
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import wide_console, write_json
    from services.planner.profile_file import profile_of_file
    from services.planner.profiles import profile_named

    if tours is None:
        raise ExperimentError("--tours DIR is missing: a folder of tours (deploy/PHOTOGRAPHS.md)")
    name, read = pipeline or "sift", read_tours(tours)
    asked = profile or "default"
    rules = profile_of_file(Path(asked)) if asked.endswith(".json") else profile_named(asked)
    with (
        wide_console(stderr=True).status("") as status,
        eyes(name, rules, seed, jobs or os.cpu_count() or 1, status.update) as looking,
    ):
        found = measure(read, looking, quick=quick)
    figures = report(found, name)
    write_json(json_file, figures)
    show(figures)
    return len(found.links)
