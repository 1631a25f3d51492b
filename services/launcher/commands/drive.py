"""`topnav drive`: move a robot by hand for a while, from the shell."""

import getpass
import time
from typing import Annotated, Literal

import typer

from services.launcher.terminal import options

app = typer.Typer()

PERIOD_S = 0.1
"""A wish holds for 0.4 s: of four one has to arrive."""
MEETING_S = 2.0
"""Before the first wish: the drive service has to be there to hear it."""

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
    from services.launcher.client.address import find_address
    from services.launcher.client.failure import ExperimentError
    from shared.bus import wait_until
    from shared.messages.drive import Manual
    from shared.topics import MANUAL, VELOCITY

    address = find_address(endpoint, data_dir)
    if address is None:
        raise ExperimentError(f"no stack runs in {data_dir}: start one (topnav up), or name its --endpoint")
    name = (who or getpass.getuser())[:64]
    with address.open() as bus:
        drivers: set[str] = set()
        bus.watch_alive(lambda _service, instance, alive: drivers.add(instance) if alive else None, "drive")
        if not wait_until(lambda: bool(drivers), MEETING_S):
            raise ExperimentError("no drive service is there: see topnav status")
        told, wishes = bus.subscribe(VELOCITY, robot=robot), bus.publisher(MANUAL, robot=robot)

        def say(action: Literal["drive", "release"]) -> None:
            now_ns = time.time_ns()
            wishes.put(
                Manual(
                    seq=now_ns // 1_000_000,
                    stamp_ns=now_ns,
                    robot=robot,
                    who=name,
                    action=action,
                    forward_mps=forward,
                    left_mps=left,
                    turn_radps=turn,
                )
            )

        began_s, answers = time.monotonic(), []
        try:
            while time.monotonic() - began_s < seconds:
                say("drive")
                time.sleep(PERIOD_S)
                answers += [velocity for velocity in told.take_all() if velocity.why == f"by hand: {name}"]
        finally:
            say("release")
    if not answers:
        raise ExperimentError(f"{robot} did not obey: somebody else drives it, or its emergency stop holds")
    fastest = max(answers, key=lambda velocity: velocity.speed_mps)
    typer.echo(f"{robot}: {len(answers)} velocities, at most {fastest.speed_mps:.2f} m/s")
