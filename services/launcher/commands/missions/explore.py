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
    curve: Annotated[Path | None, typer.Option(help="Draw coverage over driven metres to this PNG.")] = None,
    profile: options.ProfileName = None,
    pipeline: options.PipelineName = None,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Explore a world and build a map of pictures."""
    from services.launcher.client import failure, run_record, stack
    from services.launcher.drawing import curves, plans
    from services.launcher.evaluation import exploration, truth_file
    from services.launcher.terminal import output, progress
    from simulator.world import freespace, world_file

    started, file = datetime.now(UTC), world_file.load_world(world)
    space, path = freespace.free_space(file), truth_file.truth_path(data_dir, map_name)
    choice = stack.StackChoice(
        data_dir, world, seed, lockstep, profile, pipeline, endpoint, timeout_s=timeout_s
    )
    with stack.open_stack(choice) as opened:
        output.print_warning(stack.other_world(opened, world))
        before = exploration.make_room(opened, map_name, path, go_on=continue_, fresh=fresh)
        with progress.mission_progress(output.wide_console(stderr=True), f"exploring {world}") as watch:
            result = exploration.explore(opened, world, map_name, seed, max_steps, before, watch)
    truth_file.save_truth(path, map_name, result.truth)
    report = exploration.figures(result, space, map_name, seed)
    output.write_json(json_file, report)
    run_record.keep_run(
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
        plans.draw_map(drawing, file, result.truth.poses, result.graph.edges)
    if curve is not None:
        curves.draw_coverage(curve, f"exploring {world}", {"topnav": exploration.curve(result, space)})
    output.print_figures(f"map {map_name}", report)
    if not result.run.succeeded:
        status = result.run.status
        raise failure.ExperimentError(f"exploration ended as {status.state}: {status.reason}")
