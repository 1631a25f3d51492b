"""`topnav drive`: move a robot by hand for a while, from the shell."""

import getpass
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()

Forward = Annotated[float, typer.Option(min=-2.0, max=2.0, help="Metres a second ahead.")]
Left = Annotated[float, typer.Option(min=-2.0, max=2.0, help="To the left, if its base can.")]
Turn = Annotated[float, typer.Option(min=-3.0, max=3.0, help="Radians a second, counter-clockwise.")]
Seconds = Annotated[float, typer.Option(min=0.1, max=60.0, help="For how long.")]


@app.command()
def drive(
    forward: Forward = 0.0,
    left: Left = 0.0,
    turn: Turn = 0.0,
    seconds: Seconds = 1.0,
    robot: Annotated[str, typer.Option(help="Which robot.")] = "r1",
    who: Annotated[str, typer.Option(help="Your name, for the others.")] = "",
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Move a robot by hand: slower before what is near, never into it; Ctrl-C lets it stand.

    A mission that runs is paused; resume it in the console or over HTTP.
    """
    from services.launcher.client.address import running_address
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.hand import Hand

    address = running_address(endpoint, data_dir)
    with address.open() as bus:
        answers = Hand(bus, robot, who or getpass.getuser()).move(forward, left, turn, seconds)
    if not answers:
        raise ExperimentError(f"{robot} did not obey: somebody else drives it, or its emergency stop holds")
    fastest_mps = max(velocity.speed_mps for velocity in answers)
    typer.echo(f"{robot}: {len(answers)} velocities, at most {fastest_mps:.2f} m/s")
