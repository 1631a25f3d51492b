"""`topnav calibrate`: measure what a pipeline's similarity means, and propose the planner's thresholds."""

from pathlib import Path
from typing import Annotated

import typer

from experiments.calibration.thresholds import propose
from experiments.studies.heading_frames import measure
from experiments.studies.pair_tables import distance_table
from services.launcher.evaluation.environments import environment_of
from services.launcher.terminal import options
from services.launcher.terminal.output import write_json
from services.launcher.terminal.tables import print_figures, print_rows

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def main(
    world: options.World = "apartment",
    pipeline: Annotated[
        str | None, typer.Option(help="Feature pipeline to measure; default: the one that suits the world.")
    ] = None,
    pairs: Annotated[int, typer.Option(min=20, help="How many pairs of frames.")] = 500,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    write: Annotated[
        Path | None, typer.Option(help="Write a profile with these thresholds, for --profile FILE.")
    ] = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Measure the thresholds of a pipeline on rendered pairs of frames."""
    place = environment_of(world)
    pipeline = pipeline or place.pipeline or "sift"
    results = measure(world, pairs, seed, pipeline, data_dir, place.spans.pair_m)
    proposal, rows = propose(results, place.spans), distance_table(results)
    facts = {"world": world, "pipeline": pipeline, "pairs": len(results), "seed": seed}
    if json_file is not None:
        write_json(json_file, {**facts, "thresholds": proposal, "by_distance": rows})
    if write is not None:
        base = place.profile(None) or "default"
        write_json(write, {"base": base, "thresholds": proposal, "measured": facts})
    print_rows(f"{pipeline} by distance", rows)
    print_figures("proposed thresholds", proposal)
