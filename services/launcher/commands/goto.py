"""`topnav goto`: drive to where a picture was taken."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def goto(
    image: Annotated[
        Path | None, typer.Option(help="An equirectangular picture, twice as wide as high.")
    ] = None,
    photo: Annotated[Path | None, typer.Option(help="Or an ordinary photo, to be faced as well.")] = None,
    field_of_view_deg: options.FieldOfView = None,
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
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Drive to where a picture was taken; to where a photo was taken, and look as it does."""
    from services.launcher.client import failure, maps, mission, stack, trail
    from services.launcher.client.photo import locate_photo, photo_from_file
    from services.launcher.drawing.pictures import frame_from_file
    from services.launcher.terminal.output import (
        print_figures,
        print_warning,
        rounded,
        wide_console,
        write_json,
    )
    from services.launcher.terminal.progress import mission_progress
    from shared.messages.missions import MissionRequest

    picture = photo or image
    if picture is None or (photo is not None and image is not None):
        raise typer.BadParameter("goto needs --image FILE or --photo FILE, exactly one of them")
    shot = None if photo is None else photo_from_file(photo, field_of_view_deg)
    choice = stack.StackChoice(
        data_dir, world, seed, lockstep, profile, pipeline, endpoint, timeout_s=timeout_s
    )
    with stack.open_stack(choice) as opened:
        print_warning(stack.other_world(opened, world))
        known = maps.require_map(opened, map_name)
        client = mission.MissionClient(opened.bus, opened.robot)
        if shot is not None:
            goal = locate_photo(opened.bus, opened.robot, known, shot).features
        else:
            goal = mission.goal_features(opened.bus, frame_from_file(picture, opened.robot))
        request = MissionRequest(action="goto", map=map_name, goal=goal, seed=seed, max_steps=max_steps)
        with mission_progress(wide_console(stderr=True), f"going to {picture.name}") as watch:
            run = client.run(request, watch)
    report = {
        "map": map_name,
        "image": str(picture),
        "success": run.succeeded,
        "failure": run.status.failure,
        "reason": run.status.reason,
        "steps": run.status.step,
        "driven_m": rounded(trail.driven_m(run.truths), 3),
        "wall_s": rounded(run.wall_s, 2),
        "steps_per_s": rounded(run.steps_per_s, 2),
    }
    write_json(json_file, report)
    print_figures(f"goto {picture.name}", report)
    if not run.succeeded:
        why = run.status.failure or run.status.state
        raise failure.ExperimentError(f"did not arrive, {why}: {run.status.reason}")
