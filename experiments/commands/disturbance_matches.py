"""`topnav study disturbance-matches`: disturbed frames against clean ones, and render times."""

from typing import Annotated, Any

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("disturbance-matches")
@on_record("study disturbance-matches")
def disturbance_matches(
    world: options.World = "apartment",
    levels: Annotated[str, typer.Option(help="Levels from 0 to 1.")] = "0.5,1",
    pairs: Annotated[int, typer.Option(min=1, help="Pairs of poses 1 m apart.")] = 20,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
) -> int:
    """What each disturbance leaves of the verified matches between frames 1 m apart, and what it costs."""
    from experiments.rendered.disturbed import APART_M, measured
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.terminal.output import print_rows, write_json
    from simulator.world.world_file import load_world

    chosen, numbers = Pipeline(find_profile(pipeline or "sift")), [float(each) for each in levels.split(",")]
    rows: list[dict[str, Any]] = []
    for row in measured(load_world(world), chosen, numbers, pairs, seed):
        rows.append(row)
        write_json(json_file, {"world": world, "seed": seed, "pairs": pairs, "results": rows})
    print_rows(f"frames {APART_M:g} m apart in {world}", rows)
    return len(rows)
