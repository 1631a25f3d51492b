"""`topnav goto`: drive to where a picture was taken."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def goto(
    image: Annotated[Path, typer.Option(help="An equirectangular picture, twice as wide as high.")],
    map_name: options.MapName = "flat",
    world: options.World = "apartment",
    seed: options.Seed = 1,
    lockstep: options.Lockstep = None,
    json_file: options.JsonFile = None,
    profile: options.ProfileName = None,
    pipeline: options.PipelineName = None,
    max_steps: options.MaxSteps = 1500,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Drive to where a picture was taken."""
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.maps import require_map
    from services.launcher.client.mission import MissionClient, goal_features
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.client.trail import driven_m
    from services.launcher.drawing.pictures import frame_from_file
    from services.launcher.terminal.output import print_figures, rounded, wide_console, write_json
    from services.launcher.terminal.progress import mission_progress
    from shared.messages import MissionRequest

    choice = StackChoice(data_dir, world, seed, lockstep, profile, pipeline, endpoint)
    with open_stack(choice) as stack:
        require_map(stack, map_name)
        client = MissionClient(stack.bus, stack.robot)
        goal = goal_features(stack.bus, frame_from_file(image, stack.robot))
        request = MissionRequest(action="goto", map=map_name, goal=goal, seed=seed, max_steps=max_steps)
        with mission_progress(wide_console(stderr=True), f"going to {image.name}") as watch:
            run = client.run(request, watch)
    report = {
        "map": map_name,
        "image": str(image),
        "success": run.succeeded,
        "failure": run.status.failure,
        "reason": run.status.reason,
        "steps": run.status.step,
        "driven_m": rounded(driven_m(run.truths), 3),
        "wall_s": rounded(run.wall_s, 2),
        "steps_per_s": rounded(run.steps_per_s, 2),
    }
    write_json(json_file, report)
    print_figures(f"goto {image.name}", report)
    if not run.succeeded:
        raise ExperimentError(
            f"did not arrive, {run.status.failure or run.status.state}: {run.status.reason}"
        )
