"""`topnav goto`: drive to where a picture or a photo was taken, to a place, to a sign, or home."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from services.launcher.client.mission import MissionRun

app = typer.Typer()

Image = Annotated[Path | None, typer.Option(help="An equirectangular picture, twice as wide as high.")]
PhotoFile = Annotated[Path | None, typer.Option("--photo", help="An ordinary photo, to be faced as well.")]
PlaceName = Annotated[str | None, typer.Option(help="A place by its name; see 'topnav place'.")]
SignText = Annotated[
    str | None, typer.Option("--sign", help="What a sign says, such as \"room 214\"; see 'topnav signs'.")
]
Home = Annotated[bool, typer.Option("--home", help="The place called home.")]


@app.command()
def goto(
    image: Image = None,
    photo: PhotoFile = None,
    field_of_view_deg: options.FieldOfView = None,
    place: PlaceName = None,
    sign: SignText = None,
    home: Home = False,
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
    """Drive to where a picture or a photo was taken, to a named place, to a sign, or home."""
    from services.launcher.client import failure, maps, mission, stack
    from services.launcher.client.photo import locate_photo, photo_from_file
    from services.launcher.drawing.pictures import frame_from_file
    from services.launcher.terminal import output
    from services.launcher.terminal.progress import mission_progress
    from shared.messages.missions import MissionRequest, Parameters

    action, names = "home" if home else "goto", {"place": place, "sign": sign}
    _check_one_goal(image, photo, names, home, field_of_view_deg)
    picture = image or photo
    goal_name = picture.name if picture is not None else place or sign or "home"
    shot = None if photo is None else photo_from_file(photo, field_of_view_deg)
    choice = stack.StackChoice(
        data_dir, world, seed, lockstep, profile, pipeline, endpoint, timeout_s=timeout_s
    )
    with stack.open_stack(choice) as opened:
        output.print_warning(stack.other_world(opened, world))
        known = maps.require_map(opened, map_name)
        client = mission.MissionClient(opened.bus, opened.robot)
        goal = image and mission.goal_features(opened.bus, frame_from_file(image, opened.robot))
        if shot is not None:
            goal = locate_photo(opened.bus, opened.robot, known, shot).features
        given: Parameters = {n: v for n, v in names.items() if v is not None}
        request = MissionRequest(
            action=action, map=map_name, goal=goal, parameters=given, seed=seed, max_steps=max_steps
        )
        with mission_progress(output.wide_console(stderr=True), f"going to {goal_name}") as watch:
            run = client.run(request, watch)
    report = {
        "map": map_name,
        "image": None if image is None else str(image),
        "photo": None if photo is None else str(photo),
        **{**names, "place": "home" if home else place},
        **_figures(run),
    }
    output.write_json(json_file, report)
    output.print_figures(f"goto {goal_name}", report)
    if not run.succeeded:
        why = run.status.failure or run.status.state
        raise failure.ExperimentError(f"did not arrive, {why}: {run.status.reason}")


def _figures(run: "MissionRun") -> dict[str, Any]:
    from services.launcher.client import trail
    from services.launcher.terminal.output import rounded

    return {
        "success": run.succeeded,
        "failure": run.status.failure,
        "reason": run.status.reason,
        "steps": run.status.step,
        "driven_m": rounded(trail.driven_m(run.truths), 3),
        "wall_s": rounded(run.wall_s, 2),
        "steps_per_s": rounded(run.steps_per_s, 2),
    }


def _check_one_goal(
    image: Path | None,
    photo: Path | None,
    names: dict[str, str | None],
    home: bool,
    field_of_view_deg: float | None,
) -> None:
    told = {
        "--image": image,
        "--photo": photo,
        **{f"--{n}": v for n, v in names.items()},
        "--home": home or None,
    }
    given = [option for option, value in told.items() if value is not None]
    if len(given) != 1:
        raise typer.BadParameter(
            f"one of {', '.join(told)} says where to go, given: {', '.join(given) or 'none'}"
        )
    if field_of_view_deg is not None and photo is None:
        raise typer.BadParameter(
            f"--field-of-view-deg is of an ordinary photo, given {given[0]}: give it with --photo"
        )
