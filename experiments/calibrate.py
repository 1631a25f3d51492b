"""`topnav calibrate`: measure what a pipeline's similarity means, and propose the planner's thresholds."""

from typing import Annotated

import typer

from experiments import options
from experiments.calibration import propose
from experiments.output import write_json
from experiments.studies.heading_frames import measure
from experiments.studies.pair_tables import distance_table
from experiments.tables import print_figures, print_rows

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def main(
    world: options.World = "apartment",
    pipeline: Annotated[str, typer.Option(help="Feature pipeline to measure.")] = "sift",
    pairs: Annotated[int, typer.Option(min=20, help="How many pairs of frames.")] = 500,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Measure the thresholds of a pipeline on rendered pairs of frames."""
    results = measure(world, pairs, seed, pipeline, data_dir)
    proposal, rows = propose(results), distance_table(results)
    if json_file is not None:
        facts = {"world": world, "pipeline": pipeline, "pairs": len(results), "seed": seed}
        write_json(json_file, {**facts, "thresholds": proposal, "by_distance": rows})
    print_rows(f"{pipeline} by distance", rows)
    print_figures("proposed thresholds", proposal)
