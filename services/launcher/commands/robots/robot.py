"""`topnav robot check`: a new robot's first quarter of an hour."""

import getpass
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()
robot = typer.Typer(no_args_is_help=True, help="Whether a robot is what topnav takes it for.")
app.add_typer(robot, name="robot")


@robot.command()
def check(
    name: Annotated[str, typer.Option("--robot", help="Which robot.")] = "r1",
    boxes: Annotated[
        bool, typer.Option("--boxes/--no-boxes", help="Ask for a box ahead and one at the left.")
    ] = True,
    move: Annotated[
        bool, typer.Option("--move/--no-move", help="Go 0.2 m each way, turn, and stop, by hand.")
    ] = True,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask before it moves.")] = False,
    who: Annotated[str, typer.Option(help="Your name: you stand beside it.")] = "",
    picture: Annotated[
        Path, typer.Option(help="Where a picture with horizon and directions marked goes, .png.")
    ] = Path("robot-check.png"),
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Check camera, distances, directions of motion, delay and stops of a robot whose stack runs.

    Each finding is a line; what is wrong says what to do. Exit 1 where something is.
    """
    from services.launcher.checking.check import RobotCheck
    from services.launcher.client.address import running_address
    from services.launcher.client.failure import one_line_errors
    from services.launcher.processes.state import StateFolder
    from services.launcher.terminal.output import write_json

    address = running_address(endpoint, data_dir)
    logs = StateFolder(data_dir.resolve()).logs
    with one_line_errors(), address.open() as bus:
        checked = RobotCheck(bus, name, who or getpass.getuser(), logs, _say)
        enough = checked.senses()
        if checked.picture is not None:
            picture.write_bytes(checked.picture)
            _say("picture", f"{picture}: is AHEAD ahead, is LEFT left, can you read what is written there?")
        if enough and boxes:
            checked.boxes(_ask)
        if enough and move:
            if not yes:
                _ask("the robot where 0.7 m are free all round, and a hand on its switch: it moves now")
            checked.moves()
            checked.stops()
    write_json(json_file, {**checked.figures, "problems": checked.problems})
    raise typer.Exit(1 if checked.problems else 0)


def _say(word: str, text: str) -> None:
    typer.echo(f"{word:9} {text}")


def _ask(what: str) -> None:
    typer.prompt(f"{'put':9} {what}; then Enter", default="", show_default=False, prompt_suffix=" ")
