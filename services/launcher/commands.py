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
        "experiments.demo", "Explore the apartment, then find a hidden robot from its picture."
    ),
    "explore": LazyCommand("experiments.explore", "Explore a world and build a map of pictures."),
    "goto": LazyCommand("experiments.goto", "Drive to where a picture was taken."),
    "estop": LazyCommand("experiments.estop", "Stop a robot at once; only a person lets it go again."),
    "hide-and-seek": LazyCommand("experiments.hide_and_seek", "The thesis's evaluation: find hidden robots."),
    "study": LazyCommand("experiments.studies", "Experiments on headings, matching, disturbances and scale."),
    "calibrate": LazyCommand("experiments.calibrate", "Measure the thresholds of a pipeline."),
    "bench": LazyCommand("experiments.bench", "Time the stages of the control loop."),
    "world": LazyCommand("experiments.worlds", "Check a world file before anybody drives in it."),
    "models": LazyCommand("experiments.models", "Trained weights of the learned pipelines."),
    "record": LazyCommand("experiments.recordings.record", "Write what the bus says into an MCAP file."),
    "replay": LazyCommand("experiments.recordings.replay", "Play a recording, as if live."),
    "recover": LazyCommand("experiments.recordings.recover", "Save what is in a broken recording."),
    "foxglove": LazyCommand("experiments.recordings.foxglove", "Convert a recording for Foxglove."),
    "soak": LazyCommand("experiments.soak.command", "Missions without end while services break."),
    "map": LazyCommand("experiments.maps", "List, move, check, mend and keep maps."),
    "certs": LazyCommand(
        "services.launcher.certs", "Make, renew and check the certificates of a secured stack."
    ),
    "token": LazyCommand("services.launcher.tokens", "Make, list and take away tokens of the gateway."),
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
