"""`topnav up`: keep a stack running in this process, or in one left behind."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from services.launcher.processes.state import ServiceStatus

app = typer.Typer()

Foxglove = Annotated[
    int | None, typer.Option(min=1, max=65535, help="Port of a live view for Foxglove, as 8765.")
]
Fleet = Annotated[bool, typer.Option("--fleet", help="Hand out tasks for whichever robot as well.")]
Signs = Annotated[bool, typer.Option("--signs", help="Read signs while exploring; see 'topnav signs'.")]


@app.command()
def up(
    world: Annotated[
        str | None, typer.Option(help="A world that comes with topnav, or a .yaml file.")
    ] = None,
    lockstep: Annotated[
        bool | None, typer.Option(help="As fast as the machine allows; same seed, same path.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Of every random draw.")] = None,
    camera: Annotated[str | None, typer.Option(help="A real camera's URL; no simulator runs then.")] = None,
    ros: Annotated[str | None, typer.Option(help="A ROS 2 robot's file; no simulator runs then.")] = None,
    foxglove: Foxglove = None,
    signs: Signs = False,
    fleet: Fleet = False,
    profile: Annotated[
        str | None, typer.Option(help="Rules of planner and drive: default or thesis.")
    ] = None,
    secure: Annotated[
        bool, typer.Option("--secure/--open", help="Certificates and access rules on the bus.")
    ] = False,
    detach: Annotated[
        bool, typer.Option("--detach/--foreground", help="Return once all is healthy.")
    ] = False,
    data_dir: options.StackDir = options.DATA_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
    file: Annotated[
        Path | None,
        typer.Option("--file", "-f", help="Which processes there are.", show_default="docker-compose.yml"),
    ] = None,
) -> None:
    """Start the processes of docker-compose.yml on this machine."""
    from rich.console import Console

    from services.launcher.compose.compose_file import COMPOSE_FILE
    from services.launcher.processes.running import run_foreground, start_detached
    from services.launcher.processes.stack_settings import StackSettings
    from services.launcher.terminal.progress import LinesNowAndThen, start_progress
    from services.launcher.terminal.services import Changes, status_table

    choices: dict[str, Any] = {"world": world, "lockstep": lockstep, "seed": seed, "profile": profile}
    choices |= {"camera": camera, "ros": ros, "foxglove": foxglove, "signs": signs, "fleet": fleet}
    settings = StackSettings(data_dir.resolve(), **choices, secure=secure)
    compose_file, console = (file or COMPOSE_FILE).resolve(), Console()
    if detach:
        with start_progress() as told:
            state = start_detached(settings, compose_file, timeout_s, told)
        console.print(status_table(state.services))
        console.print(f"console {state.gateway_url}; stop with 'topnav down'", highlight=False)
    else:
        changes = Changes()

        def watch(services: Mapping[str, "ServiceStatus"]) -> None:
            for line in changes.lines(services):
                console.print(line, highlight=False)

        def healthy(url: str) -> None:
            console.print(f"all healthy; console {url}, stop with Ctrl+C or 'topnav down'")

        lines = LinesNowAndThen(lambda text: console.print(f"waiting for {text}", highlight=False))
        run_foreground(settings, compose_file, timeout_s, watch, healthy, lines)
