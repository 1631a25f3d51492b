"""`topnav estop`: stop a robot at once; only a person lets it go again."""

import getpass
import os
from datetime import datetime
from typing import TYPE_CHECKING, Annotated

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from shared.messages.estop import EStopRequest, EStopState

app = typer.Typer()

TIMEOUT_S = 2.0
"""Whoever presses the emergency stop waits no longer to hear that nobody answers."""

ENGAGED, UNKNOWN = 1, 2
"""Exit codes besides 0."""

Robot = Annotated[str, typer.Option(help="Which robot.")]
Why = Annotated[str, typer.Option(help="Reason, for the others.")]
Clear = Annotated[bool, typer.Option("--clear", help="Let the robot go; needs --who.")]
Who = Annotated[str, typer.Option(help="Name of the person who looked.")]
Status = Annotated[bool, typer.Option("--status", help="Only say how it stands; exit 1 when engaged.")]


@app.command()
def estop(
    robot: Robot = "r1",
    why: Why = "",
    clear: Clear = False,
    who: Who = "",
    status: Status = False,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Stop a robot at once; only a person lets it go again.

    With --clear end the stop, with --status look.
    """
    from services.launcher.client.address import address_at, find_address
    from shared.queries import AbsentError, RefusedError, TimedOutError
    from shared.settings import ServiceSettings
    from shared.topics import ESTOP

    _check_robot(robot)
    request = _request(why, clear, who.strip(), status)
    # The router of the stack that runs in the folder, else the usual one: no other setting keeps from a stop.
    usual = os.environ.get("TOPNAV_ENDPOINT") or ServiceSettings.model_fields["endpoint"].default
    address = find_address(endpoint, data_dir) or address_at(usual)
    try:
        with address.open() as bus:
            state = bus.ask(ESTOP, request, TIMEOUT_S, robot=robot)
    except (AbsentError, TimedOutError):
        typer.echo("topnav: no drive service answers: the robot's own time-out stops it", err=True)
        raise typer.Exit(UNKNOWN) from None
    except RefusedError as error:
        typer.echo(f"topnav: {error}", err=True)
        raise typer.Exit(UNKNOWN) from None
    typer.echo(_sentence(state))
    raise typer.Exit(ENGAGED if status and state.engaged else 0)


def _check_robot(robot: str) -> None:
    from shared.transport.keys import check_robot

    try:
        check_robot(robot)
    except ValueError as error:
        raise typer.BadParameter(f"--robot: {error}") from None


def _request(why: str, clear: bool, who: str, status: bool) -> "EStopRequest":
    from shared.messages.estop import EStopRequest

    if clear and status:
        raise typer.BadParameter("--clear and --status exclude each other")
    if clear and not who:
        raise typer.BadParameter("--clear needs --who NAME: the person who saw that the robot may move")
    if status:
        return EStopRequest(action="status")
    who = (who or getpass.getuser())[:64]
    return EStopRequest(action="clear" if clear else "engage", who=who, why=why[:400])


def _sentence(state: "EStopState") -> str:
    word = "engaged" if state.engaged else "clear"
    if not state.since_ns:
        return f"{state.robot}: {word}{f' ({state.why})' if state.why else ''}"
    since = datetime.fromtimestamp(state.since_ns / 1e9).astimezone().isoformat(sep=" ", timespec="seconds")
    why = f": {state.why}" if state.why else ""
    return f"{state.robot}: {word} since {since} by {state.who or 'nobody named'}{why}"
