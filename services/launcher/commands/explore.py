"""`topnav explore`: explore a world, keep the map, and say how good it is."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()

RECORDED = ("nodes", "edges", "coverage", "collisions", "false_edges", "steps", "steps_per_s", "outcome")


@app.command()
def explore(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    seed: options.Seed = 1,
    lockstep: options.Lockstep = None,
    json_file: options.JsonFile = None,
    continue_: Annotated[bool, typer.Option("--continue", help="Go on with a map that exists.")] = False,
    fresh: Annotated[bool, typer.Option("--fresh", help="Delete a map of this name first.")] = False,
    max_steps: options.MaxSteps = 30_000,
    drawing: Annotated[Path | None, typer.Option(help="Draw the map to this PNG.")] = None,
    profile: options.ProfileName = None,
    pipeline: options.PipelineName = None,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Explore a world and build a map of pictures."""
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.run_record import keep_run
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.drawing.plans import draw_map
    from services.launcher.evaluation.exploration import explore, figures, make_room
    from services.launcher.evaluation.truth_file import save_truth, truth_path
    from services.launcher.terminal.output import print_figures, wide_console, write_json
    from services.launcher.terminal.progress import mission_progress
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    started, space = datetime.now(UTC), free_space(load_world(world))
    choice = StackChoice(data_dir, world, seed, lockstep, profile, pipeline, endpoint)
    path = truth_path(data_dir, map_name)
    with open_stack(choice) as stack:
        before = make_room(stack, map_name, path, go_on=continue_, fresh=fresh)
        with mission_progress(wide_console(stderr=True), f"exploring {world}") as watch:
            result = explore(stack, world, map_name, seed, max_steps, before, watch)
    save_truth(path, map_name, result.truth)
    report = figures(result, space, map_name, seed)
    write_json(json_file, report)
    keep_run(
        data_dir,
        "explore",
        started,
        {name: report[name] for name in RECORDED},
        worlds=[world],
        map_name=map_name,
        seed=seed,
        json_file=json_file,
    )
    if drawing is not None:
        draw_map(drawing, load_world(world), result.truth.poses, result.graph.edges)
    print_figures(f"map {map_name}", report)
    if not result.run.succeeded:
        raise ExperimentError(f"exploration ended as {result.run.status.state}: {result.run.status.reason}")
