"""`topnav study keypoints`: which keypoints recur, and what a matcher that knows the truth would answer."""

from typing import Annotated, Any

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

WORLDS, PAIRS = 10, 6  # one world of each kind; 60 pairs a distance: a share is known to 3 points
DETECTORS = "sift,orb,aliked-t16,keynet"
WIDTH_PX = 1024  # of the running stack


@app.command("keypoints")
@on_record("study keypoints")
def keypoints(
    worlds: Annotated[int, typer.Option(min=1, help="Validation worlds, kinds and sizes in turn.")] = WORLDS,
    pairs: Annotated[int, typer.Option(min=1, help="Pairs of pictures per world and distance.")] = PAIRS,
    only: Annotated[str, typer.Option(help="keynet and extractors, separated by commas.")] = DETECTORS,
    sizes: Annotated[str, typer.Option(help="Only worlds of these sizes; default: all.")] = "",
    jobs: Annotated[int, typer.Option(min=1, help="Worlds at a time.")] = 1,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,  # noqa: ARG001 - where the run is recorded
) -> int:
    """Share of keypoints that recur within 1 degree at 0.5 to 5 m, and what an oracle on SIFT's would answer.

    Goes on where --json F stopped. Detectors without trained weights are listed, never measured.
    """
    from experiments.training.keypoints.study import run
    from experiments.training.keypoints.tables import answer_table, recurrence_table
    from services.launcher.terminal.output import print_rows

    names = tuple(name.strip() for name in only.split(","))
    kept = [size.strip() for size in sizes.split(",") if size.strip()]
    rows: list[dict[str, Any]] = run(worlds, pairs, names, kept, WIDTH_PX, seed, jobs, json_file)
    table = recurrence_table(rows, names)
    print_rows("keypoints that recur within 1 degree", [row for row in table if "status" not in row])
    absent = [row for row in table if "status" in row]
    if absent:
        print_rows("without weights", absent)
    print_rows("answers with SIFT's keypoints", answer_table(rows))
    return len(rows)
