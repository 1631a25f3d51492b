"""`topnav calibrate`: measure what a pipeline's similarity means, and propose the planner's thresholds."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def calibrate(
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
    from experiments.rendered.headings import measure
    from experiments.rendered.tables import distance_table
    from experiments.rendered.thresholds import propose
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.client.environments import environment_of
    from services.launcher.terminal.output import print_figures, print_rows, wide_console, write_json
    from simulator.world.world_file import load_world

    place, file = environment_of(world), load_world(world)
    name = pipeline or place.pipeline or "sift"
    chosen = Pipeline(find_profile(name))
    with wide_console(stderr=True).status("") as status:
        results = measure(file, chosen, pairs, seed, data_dir, status.update, place.spans.pair_m)
    proposal, rows = propose(results, place.spans), distance_table(results)
    facts = {"world": world, "pipeline": name, "pairs": len(results), "seed": seed}
    write_json(json_file, {**facts, "thresholds": proposal, "by_distance": rows})
    base = place.profile(None) or "default"
    write_json(write, {"base": base, "thresholds": proposal, "measured": facts})
    print_rows(f"{name} by distance", rows)
    print_figures("proposed thresholds", proposal)
