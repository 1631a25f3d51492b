"""`topnav mission`: what a robot can be asked to do, and asking for any of it."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from services.launcher.terminal import options

app = typer.Typer(name="mission", no_args_is_help=True, help="Missions of any kind that the planner knows.")

Image = Annotated[Path | None, typer.Option(help="A goal picture, for kinds that take one.")]


@app.command("kinds")
def show_kinds(
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
    as_json: options.AsJson = False,
) -> None:
    """Show the kinds of mission of the running stack, with their parameters."""
    from services.launcher.client import stack
    from services.launcher.terminal.output import print_rows
    from shared.messages.missions import MissionKindsRequest
    from shared.topics import MISSION_KINDS

    with stack.open_stack(stack.StackChoice(data_dir, endpoint=endpoint, timeout_s=timeout_s)) as opened:
        reply = opened.bus.ask(MISSION_KINDS, MissionKindsRequest(), stack.ASK_TIMEOUT_S, robot=opened.robot)
    if as_json:
        typer.echo(json.dumps([kind.model_dump() for kind in reply.kinds], indent=2))
        return
    rows = [
        {"kind": kind.name, "does": kind.title, "parameters": ", ".join(_properties(kind.parameters))}
        for kind in reply.kinds
    ]
    print_rows("kinds of mission", rows)


@app.command("start")
def start(
    kind: options.Kind,
    map_name: options.MapName = "flat",
    given: options.Given = None,
    image: Image = None,
    seed: options.Seed = 1,
    max_steps: options.MaxSteps = 20_000,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
    json_file: options.JsonFile = None,
) -> None:
    """Start a mission of any kind and follow it to its end."""
    from services.launcher.client import any_mission, mission, stack
    from services.launcher.drawing.pictures import frame_from_file
    from shared.messages.missions import MissionRequest

    parameters = dict(options.named_value(text) for text in given or [])
    with stack.open_stack(stack.StackChoice(data_dir, endpoint=endpoint, timeout_s=timeout_s)) as opened:
        goal = image and mission.goal_features(opened.bus, frame_from_file(image, opened.robot))
        request = MissionRequest(
            action=kind, map=map_name, parameters=parameters, goal=goal, seed=seed, max_steps=max_steps
        )
        any_mission.run_mission(opened, request, json_file)


def _properties(schema: dict[str, Any]) -> list[str]:
    return list(schema.get("properties", {}))
