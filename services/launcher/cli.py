"""The `topnav` command: those of the product, and those that other distributions add.

A command module imports only typer and its options at its top, and its work in its function: `topnav --help`
must not wait for zenoh, torch or matplotlib.
"""

import os
import sys
from collections.abc import Iterable
from importlib.metadata import EntryPoint, entry_points

import typer

from services.launcher.commands.assets import models, world
from services.launcher.commands.maps import map, place, route, rule, signs
from services.launcher.commands.missions import explore, goto, locate, mission, schedule, task, teach
from services.launcher.commands.recordings import foxglove, record, recover, replay
from services.launcher.commands.robots import camera, drive, estop, robot
from services.launcher.commands.stack import certs, demo, doctor, down, mcp, status, token, up

ADDED = "topnav.commands"
"""Entry points of this group are Typer apps of further commands."""

STUDIES = ("hide-and-seek", "ros-demo", "suite", "study", "calibrate", "bench", "soak", "train")
"""Commands of the distribution topnav-studies; without it they say where to get it."""

app = typer.Typer(
    name="topnav",
    help="Visual navigation with one 360-degree camera: explore, remember, drive to a picture.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
for command in (
    demo,
    explore,
    goto,
    locate,
    signs,
    drive,
    teach,
    estop,
    world,
    models,
    record,
    replay,
    recover,
    foxglove,
    mcp,
):
    app.add_typer(command.app)
for command in (
    map,
    place,
    route,
    rule,
    mission,
    task,
    schedule,
    camera,
    robot,
    certs,
    token,
    up,
    down,
    status,
    doctor,
):
    app.add_typer(command.app)


class MissingCommandError(ValueError):
    """A command that is not to be had here; the text says what to do."""


def add_commands(to: typer.Typer, found: Iterable[EntryPoint]) -> None:
    """Add the commands of other distributions; what cannot be had says so when it is called."""
    names = set()
    for entry in found:
        names.add(entry.name)
        try:
            found_app = entry.load()
            if not isinstance(found_app, typer.Typer):
                raise TypeError(f"a Typer expected, got {type(found_app).__name__}")
            to.add_typer(found_app)
        except Exception as error:  # noqa: BLE001 - whatever another distribution does wrong, the rest must work
            why = f"cannot be loaded from {entry.value}: {type(error).__name__}: {error}"
            _add_missing(to, entry.name, why, hidden=False)
    for name in set(STUDIES) - names:
        why = "belongs to topnav-studies: install that ('pip install ./experiments' in a clone of topnav)"
        _add_missing(to, name, why, hidden=True)


def _add_missing(to: typer.Typer, name: str, why: str, *, hidden: bool) -> None:
    @to.command(
        name,
        help="Not available here.",
        hidden=hidden,
        add_help_option=False,
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )
    def tell() -> None:
        raise MissingCommandError(f"topnav {name} {why}")


add_commands(app, entry_points(group=ADDED))


def main() -> None:
    """Run a command; what users can mend is one line on standard error and exit 1."""
    # For commands that load torch: its threads wait by spinning, and beside one busy process a network takes
    # five times as long.
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
    try:
        app()  # reports wrong options itself and raises SystemExit
    except KeyboardInterrupt:
        sys.exit(130)
    except Exception as error:
        from services.launcher.processes.state import AlreadyRunningError
        from services.launcher.processes.wait import LaunchError

        if not isinstance(error, LaunchError | AlreadyRunningError | ValueError | OSError):
            raise
        sys.stderr.write(f"topnav: {error}\n")
        sys.exit(1)
