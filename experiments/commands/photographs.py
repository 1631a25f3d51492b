"""`topnav study photographs`: what a pipeline makes of 360-degree pictures of a real place."""

import os
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

if TYPE_CHECKING:
    from services.planner.profiles import Profile

app = typer.Typer()


class Peer(StrEnum):
    """Programs to compare with."""

    PYCOLMAP = "pycolmap"


Tours = Annotated[
    Path | None, typer.Option(help="Folder of tours: each has a tour.json beside its pictures.")
]


@app.command("photographs")
@on_record("study photographs")
def photographs(
    tours: Tours = None,
    failures: Annotated[
        Path | None, typer.Option(help="Draw wrong, wrongly connected and unanswered pairs into this folder.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw errors by tour and the reliability diagram into this PNG.")
    ] = None,
    peer: Annotated[
        Peer | None, typer.Option(help="Measure another program on the same tours; it must be installed.")
    ] = None,
    render_example: Annotated[
        Path | None, typer.Option(help="Render a tour of the apartment into this folder.")
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
    from experiments.photographs.drawing import draw
    from experiments.photographs.example import render_apartment
    from experiments.photographs.eyes import eyes
    from experiments.photographs.failures import draw_failures
    from experiments.photographs.peer import load_pycolmap, measure_peer
    from experiments.photographs.report import report, show
    from experiments.photographs.study import measure
    from experiments.photographs.tours import read_tours
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import wide_console, write_json
    from services.planner.profiles import profile_name_for

    if render_example is not None:
        example = render_apartment(render_example, seed)
        if tours is None:
            wide_console().print(f"topnav study photographs --tours {example.parent}", highlight=False)
            return 0
    if tours is None:
        raise ExperimentError("expected --tours DIR, a folder of tours, or --render-example DIR, got neither")
    name, read = pipeline or "photo", read_tours(tours)
    pycolmap = load_pycolmap() if peer is not None else None
    rules = _rules(profile or profile_name_for(name))
    with (
        wide_console(stderr=True).status("") as status,
        eyes(name, rules, seed, jobs or os.cpu_count() or 1, status.update) as looking,
    ):
        found = measure(read, looking, quick=quick)
        if failures is not None:
            draw_failures(failures, found, looking, status.update)
        figures = report(found, name)
        if pycolmap is not None:
            figures["peer"] = measure_peer(pycolmap, read, seed, status.update)
    write_json(json_file, figures)
    if plot is not None:
        draw(plot, found)
    show(figures)
    return len(found.links)


def _rules(profile: str) -> "Profile":
    """A profile by its name, or of a file."""
    from services.planner.profile_file import profile_of_file
    from services.planner.profiles import profile_named

    return profile_of_file(Path(profile)) if Path(profile).suffix else profile_named(profile)
