"""Commands that live elsewhere, imported when called so that `topnav --help` stays fast."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

import typer
from typer.main import get_command


@dataclass(frozen=True)
class LazyCommand:
    """A command implemented by the Typer app `module:app`."""

    module: str
    help: str


COMMANDS: dict[str, LazyCommand] = {
    "demo": LazyCommand(
        "services.launcher.commands.demo", "Explore the apartment, then find a hidden robot from its picture."
    ),
    "explore": LazyCommand(
        "services.launcher.commands.explore", "Explore a world and build a map of pictures."
    ),
    "goto": LazyCommand("services.launcher.commands.goto", "Drive to where a picture was taken."),
    "estop": LazyCommand(
        "services.launcher.commands.estop", "Stop a robot at once; only a person lets it go again."
    ),
    "hide-and-seek": LazyCommand(
        "experiments.hide_and_seek.command", "The thesis's evaluation: find hidden robots."
    ),
    "study": LazyCommand(
        "experiments.studies.command", "Experiments on headings, matching, disturbances and scale."
    ),
    "calibrate": LazyCommand("experiments.calibration.command", "Measure the thresholds of a pipeline."),
    "bench": LazyCommand("experiments.bench.command", "Time the stages of the control loop."),
    "world": LazyCommand(
        "services.launcher.commands.world", "Check a world file before anybody drives in it."
    ),
    "models": LazyCommand("services.launcher.commands.models", "Trained weights of the learned pipelines."),
    "record": LazyCommand("services.launcher.commands.record", "Write what the bus says into an MCAP file."),
    "replay": LazyCommand("services.launcher.commands.replay", "Play a recording, as if live."),
    "recover": LazyCommand("services.launcher.commands.recover", "Save what is in a broken recording."),
    "foxglove": LazyCommand("services.launcher.commands.foxglove", "Convert a recording for Foxglove."),
    "soak": LazyCommand("experiments.soak.command", "Missions without end while services break."),
    "map": LazyCommand("services.launcher.commands.map", "List, move, check, mend and keep maps."),
    "certs": LazyCommand(
        "services.launcher.commands.certs", "Make, renew and check the certificates of a secured stack."
    ),
    "token": LazyCommand(
        "services.launcher.commands.token", "Make, list and take away tokens of the gateway."
    ),
}


class CommandMissingError(RuntimeError):
    """A command whose module is not installed."""


def register(app: typer.Typer, commands: dict[str, LazyCommand]) -> None:
    """Add all commands to `app`; their own help and options are read only when one is called."""
    for name, command in commands.items():
        app.command(
            name,
            help=command.help,
            add_help_option=False,
            context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
        )(_forward(name, command))


def load(name: str, command: LazyCommand) -> typer.Typer:
    """Import the Typer app of a command.

    Raises:
        CommandMissingError: the module is not there, or lacks `app`.
    """
    try:
        app = import_module(command.module).app
    except ModuleNotFoundError as error:
        raise CommandMissingError(
            f"topnav {name} needs the Python module {error.name!r}: run 'make setup'"
        ) from None
    except AttributeError:
        raise CommandMissingError(
            f"topnav {name}: {command.module} must define a Typer named `app`"
        ) from None
    if not isinstance(app, typer.Typer):
        raise CommandMissingError(f"topnav {name}: {command.module}.app must be a Typer, got {type(app)}")
    return app


def _forward(name: str, command: LazyCommand) -> Callable[[typer.Context], None]:
    def run(context: typer.Context) -> None:
        get_command(load(name, command)).main(args=list(context.args), prog_name=f"topnav {name}")

    return run
