"""`topnav study matching`: descriptors, representations and matchers on the sphere (thesis, section 3.1)."""

from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("matching")
@on_record("study matching")
def matching(
    quick: Annotated[bool, typer.Option("--quick", help="One picture, three latitudes.")] = False,
    full: Annotated[bool, typer.Option("--full", help="Two pictures, nine latitudes.")] = False,
    only: Annotated[str | None, typer.Option(help='Descriptors, as "sift,orb"; default: all.')] = None,
    pictures: Annotated[
        Path | None, typer.Option(help="Folder of pictures instead of rendered views.")
    ] = None,
    timing: Annotated[bool, typer.Option(help="Measure the table of times too.")] = True,
    plots: Annotated[Path | None, typer.Option(help="Draw the curves into this folder.")] = None,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Mean average precision over latitude, longitude, blur, rotation and scale.

    Goes on where --json F stopped. Combinations without trained weights are listed, never measured.
    """
    from experiments.matching import plan, report, study
    from experiments.matching.pictures import from_folder, rendered
    from experiments.work.results_file import ResultsFile
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import wide_console

    if quick and full:
        raise ExperimentError("--quick and --full exclude each other: choose one")
    size = plan.QUICK if quick else plan.FULL if full else plan.NORMAL
    names = list(plan.DESCRIPTORS) if only is None else [name.strip() for name in only.split(",")]
    if wrong := sorted(set(names) - set(plan.DESCRIPTORS)):
        raise ExperimentError(f"--only knows {', '.join(plan.DESCRIPTORS)}, got {', '.join(wrong)}")
    folder, side_px = data_dir / "studies" / "matching", size.canvas_px // 4
    if pictures is None:
        sources = rendered(size.images, side_px, seed, folder)
    else:
        sources = from_folder(pictures, size.images, side_px)
    setup = {
        "seed": seed,
        "canvas_px": size.canvas_px,
        "images": len(sources),
        "latitudes_deg": list(size.latitudes_deg),
    }
    file = ResultsFile(json_file, setup, "timing")
    with wide_console(stderr=True).status("") as status:
        study.measure_missing(file, names, sources, size, status.update)
        if timing:
            view = rendered(1, plan.TIMED_PX // 4, seed, folder)[0]
            study.time_missing(file, names, view, status.update)
    wins = study.tangent_wins(file.results)
    file.write(tangent_wins=wins)
    found = {**file.tables, "tangent_wins": wins}
    if plots is not None:
        report.draw(plots, found, sources[0], size.canvas_px)
    report.show(found)
    return len(file.results)
