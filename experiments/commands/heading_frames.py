"""`topnav study heading-frames`: heading errors of all seven methods on rendered frame pairs."""

import math
from pathlib import Path
from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

Pairs = Annotated[int, typer.Option(min=1, help="How many pairs of frames.")]
Quick = Annotated[bool, typer.Option("--quick", help="60 pairs only.")]
Rocking = Annotated[
    float,
    typer.Option(min=0.0, max=30.0, help="1 sigma of the camera's roll and of its pitch in each frame."),
]
QUICK_PAIRS = 60  # a minute of rendering


@app.command("heading-frames")
@on_record("study heading-frames")
def heading_frames(
    world: options.World = "apartment",
    pairs: Pairs = 500,
    quick: Quick = False,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    rocking_deg: Rocking = 0.0,
    plot: Annotated[Path | None, typer.Option(help="Draw the reliability diagram into this PNG.")] = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Heading errors of all seven methods from the same matches, frames 0.3 to 3 m apart."""
    from experiments.rendered.headings import measure
    from experiments.rendered.tables import confidence_table, distance_table, method_table, status_counts
    from experiments.work.page import new_figure
    from experiments.work.reliability import draw_reliability
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.drawing.pictures import save_figure
    from services.launcher.terminal.output import print_rows, wide_console, write_json
    from simulator.world.world_file import load_world

    chosen, count = Pipeline(find_profile(pipeline or "sift")), QUICK_PAIRS if quick else pairs
    with wide_console(stderr=True).status("") as status:
        results = measure(
            load_world(world),
            chosen,
            count,
            seed,
            data_dir,
            status.update,
            rocking_rad=math.radians(rocking_deg),
        )
    verified, raw = method_table(results), method_table(results, raw=True)
    by_distance, calibration = distance_table(results), confidence_table(results)
    report = {
        "pairs": len(results),
        "methods": verified,
        "world": world,
        "seed": seed,
        "pipeline": pipeline or "sift",
        "rocking_deg": rocking_deg,
        "methods_raw_matches": raw,
        "by_distance": by_distance,
        "calibration": calibration,
        "two_view_status": status_counts(results),
    }
    write_json(json_file, report)
    if plot is not None:
        figure = new_figure(5.0, 4.5)
        draw_reliability(figure.subplots(), calibration)
        save_figure(figure, plot)
    for title, table in (("verified matches", verified), ("raw matches", raw)):
        print_rows(f"heading error, {title}", [{"method": name, **row} for name, row in table.items()])
    print_rows("by distance, epipolar", by_distance)
    print_rows("confidence of the two-view method", calibration["bins"])
    return len(results)
