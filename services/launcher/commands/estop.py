"""`topnav estop`: stop a robot at once; only a person lets it go again."""

import getpass
from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.client.address import Address, find_address
from services.launcher.client.stack import ROBOT
from services.launcher.terminal import options
from shared.messages import EStopRequest, EStopState
from shared.queries import AbsentError, RefusedError, TimedOutError
from shared.settings import ServiceSettings
from shared.topics import ESTOP

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)

TIMEOUT_S = 2.0
ENGAGED, UNKNOWN = 1, 2
"""Exit codes besides 0."""

ALONE = "no drive service answers: the robot's own time-out stops it"

Robot = Annotated[str, typer.Option(help="Which robot.")]
Why = Annotated[str, typer.Option(help="Reason, for the others.")]
Clear = Annotated[bool, typer.Option("--clear", help="Let the robot go; needs --who.")]
Who = Annotated[str, typer.Option(help="Name of the person who looked.")]
Status = Annotated[bool, typer.Option("--status", help="Only say how it stands; exit 1 when engaged.")]


@app.command()
def main(
    robot: Robot = ROBOT,
    why: Why = "",
    clear: Clear = False,
    who: Who = "",
    status: Status = False,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
) -> None:
    """Engage the emergency stop; with --clear end it, with --status look."""
    if clear and status:
        raise typer.BadParameter("--clear and --status exclude each other")
    if clear and not who.strip():
        raise typer.BadParameter("--clear needs --who NAME: the person who saw that the robot may move")
    if status:
        request = EStopRequest(action="status")
    elif clear:
        request = EStopRequest(action="clear", who=who.strip()[:64], why=why[:400])
    else:
        request = EStopRequest(action="engage", who=(who.strip() or getpass.getuser())[:64], why=why[:400])
    try:
        state = _ask(robot, request, _address(endpoint, data_dir))
    except (AbsentError, TimedOutError):
        typer.echo(f"topnav: {ALONE}", err=True)
        raise typer.Exit(UNKNOWN) from None
    except RefusedError as error:
        typer.echo(f"topnav: {error}", err=True)
        raise typer.Exit(UNKNOWN) from None
    typer.echo(_sentence(state))
    raise typer.Exit(ENGAGED if status and state.engaged else 0)


def _ask(robot: str, request: EStopRequest, address: Address) -> EStopState:
    with address.open() as bus:
        return bus.ask(ESTOP, request, TIMEOUT_S, robot=robot)


def _address(endpoint: str | None, data_dir: Path) -> Address:
    """Router of the stack that runs in the folder, else the usual one: a stop does not ask for settings."""
    usual = ServiceSettings.from_environment()
    return find_address(endpoint, data_dir) or Address(usual.endpoint, usual.certs)


def _sentence(state: EStopState) -> str:
    word = "engaged" if state.engaged else "clear"
    if not state.since_ns:
        return f"{state.robot}: {word}{f' ({state.why})' if state.why else ''}"
    since = datetime.fromtimestamp(state.since_ns / 1e9).astimezone().isoformat(sep=" ", timespec="seconds")
    why = f": {state.why}" if state.why else ""
    return f"{state.robot}: {word} since {since} by {state.who or 'nobody named'}{why}"
