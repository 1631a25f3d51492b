"""`topnav models`: trained weights of the learned pipelines."""

import os
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from services.features.networks.catalogue import TrainedModel

app = typer.Typer(name="models", no_args_is_help=True, help="Trained weights of the learned pipelines.")
Names = Annotated[list[str] | None, typer.Argument(help="Models; none: all that are there.")]


@app.command("list")
def list_models() -> None:
    """Every model: what needs it, its licence, its size, and whether it is here."""
    from services.features.networks.cache import path_of, state_of
    from services.features.networks.catalogue import MODELS
    from services.launcher.terminal.output import print_rows, wide_console

    rows = [
        {
            "model": model.name,
            "used by": ", ".join(model.pipelines),
            "licence": model.licence,
            "MB": f"{model.size_bytes / 1e6:.1f}" if model.size_bytes else "?",
            "here": state_of(model),
            "origin": model.origin,
        }
        for model in MODELS
    ]
    print_rows("trained models", rows)
    wide_console().print(f"files of kornia: {path_of(MODELS[0]).parent}")


@app.command()
def pull(
    names: Annotated[list[str], typer.Argument(help="Models to load.")],
    non_commercial: Annotated[
        bool, typer.Option("--non-commercial", help="My use is non-commercial research.")
    ] = False,
) -> None:
    """Download models through the libraries that own them, and check them."""
    from services.features.networks.catalogue import find_model
    from services.launcher.client.failure import ExperimentError

    for model in [find_model(name) for name in names]:
        if not model.commercial and not non_commercial:
            raise ExperimentError(f"{model.name}: {model.licence}: give --non-commercial if that is your use")
        _load(model)
        _print_state(model)


@app.command()
def verify(names: Names = None) -> None:
    """Compare what is here with its checksums; ends with 1 where a file is broken."""
    from services.features.networks.cache import state_of
    from services.features.networks.catalogue import MODELS, find_model
    from services.launcher.client.failure import ExperimentError

    asked = [find_model(name) for name in names or []]
    here = asked or [model for model in MODELS if state_of(model) != "absent"]
    broken = [model.name for model in here if _print_state(model) == "broken"]
    if broken:
        raise ExperimentError(
            f"broken: {', '.join(broken)}; delete the files and pull them again, or install topnav again for "
            "those that come with it"
        )


def _load(model: "TrainedModel") -> None:
    from services.features.networks.loaders import load
    from services.features.networks.runtime import DOWNLOAD, NON_COMMERCIAL, WeightsError
    from services.launcher.client.failure import ExperimentError

    os.environ[DOWNLOAD] = "1"
    if not model.commercial:
        os.environ[NON_COMMERCIAL] = "1"
    try:
        load(model)
    except (WeightsError, ImportError) as error:
        raise ExperimentError(str(error)) from error


def _print_state(model: "TrainedModel") -> str:
    from services.features.networks.cache import path_of, state_of
    from services.launcher.terminal.output import wide_console

    state = state_of(model)
    wide_console().print(f"{model.name}: {state}, {path_of(model)}")
    return state
