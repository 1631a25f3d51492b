"""The `topnav` command."""

import os
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from services.launcher.lazy_commands import COMMANDS, CommandMissingError, register

app = typer.Typer(
    name="topnav",
    help="Visual navigation with one 360-degree camera: explore, remember, drive to a picture.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
register(app, COMMANDS)

DataDir = Annotated[Path, typer.Option(envvar="TOPNAV_DATA_DIR", help="Maps, logs and state live here.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]
DEFAULT_DATA_DIR = Path("data")
COMPOSE_FILE = Path(__file__).resolve().parents[2] / "docker-compose.yml"


@app.command()
def up(
    world: Annotated[
        str | None, typer.Option(help="A world that comes with topnav, or a .yaml file.")
    ] = None,
    lockstep: Annotated[
        bool | None, typer.Option(help="As fast as the machine allows; same seed, same path.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Of every random draw.")] = None,
    profile: Annotated[
        str | None, typer.Option(help="Rules of planner and drive: default or thesis.")
    ] = None,
    secure: Annotated[
        bool, typer.Option("--secure/--open", help="Certificates and access rules on the bus.")
    ] = False,
    detach: Annotated[
        bool, typer.Option("--detach/--foreground", help="Return once all is healthy.")
    ] = False,
    data_dir: DataDir = DEFAULT_DATA_DIR,
    timeout_s: Annotated[float, typer.Option(help="How long the start may take.")] = 120.0,
    file: Annotated[Path, typer.Option("--file", "-f", help="Which processes there are.")] = COMPOSE_FILE,
) -> None:
    """Start the processes of docker-compose.yml on this machine."""
    from services.launcher.commands.up import run_detached, run_foreground
    from services.launcher.processes.stack_settings import StackSettings

    choices: dict[str, Any] = {"world": world, "lockstep": lockstep, "seed": seed, "profile": profile}
    settings = StackSettings(data_dir.resolve(), **choices, secure=secure)
    if detach:
        run_detached(settings, file.resolve(), timeout_s)
    else:
        run_foreground(settings, file.resolve(), timeout_s)


@app.command()
def down(
    data_dir: DataDir = DEFAULT_DATA_DIR,
    timeout_s: Annotated[float, typer.Option(help="Kill the launcher after this.")] = 30.0,
) -> None:
    """Stop the stack of a data folder."""
    from services.launcher.commands.down import stop_stack

    typer.echo(stop_stack(data_dir.resolve(), timeout_s))


@app.command()
def status(data_dir: DataDir = DEFAULT_DATA_DIR, as_json: AsJson = False) -> None:
    """Show the stack of a data folder; exit 1 unless every service is healthy."""
    from services.launcher.processes.state import StateFolder
    from services.launcher.terminal.display import status_table

    state = StateFolder(data_dir.resolve()).read()
    if as_json:
        typer.echo(state.model_dump_json(indent=2) if state else "null")
    elif state is None:
        typer.echo(f"no stack runs in {data_dir}; start one with 'topnav up'")
    else:
        console = Console()
        console.print(status_table(state.services))
        console.print(
            f"console {state.gateway_url}  bus {state.endpoint}  logs {state.logs}", highlight=False
        )
    raise typer.Exit(0 if state and state.healthy else 1)


@app.command()
def doctor(data_dir: DataDir = DEFAULT_DATA_DIR, as_json: AsJson = False) -> None:
    """Say what this machine lacks for a run and how to fix it; exit 1 when something is missing."""
    import json
    from dataclasses import asdict

    from services.launcher.commands.doctor import examine
    from services.launcher.processes.stack_settings import Ports
    from services.launcher.terminal.display import check_table

    checks = examine(data_dir.resolve(), Ports.from_variables(os.environ))
    if as_json:
        typer.echo(json.dumps([asdict(check) for check in checks], indent=2))
    else:
        Console().print(check_table(checks), highlight=False)
    raise typer.Exit(0 if all(check.ok for check in checks) else 1)


def main() -> None:
    """Run a command; what users can mend is one line on standard error and exit 1."""
    from services.launcher.processes.state import AlreadyRunningError
    from services.launcher.processes.wait import LaunchError

    try:
        app()  # reports wrong options itself and raises SystemExit
    except KeyboardInterrupt:
        sys.exit(130)
    except (LaunchError, AlreadyRunningError, CommandMissingError, ValueError, OSError) as error:
        sys.stderr.write(f"topnav: {error}\n")
        sys.exit(1)
