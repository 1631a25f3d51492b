"""`topnav suite`: the main job in many worlds."""

from datetime import UTC, datetime
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="suite", no_args_is_help=True, help="The main job in many worlds that nobody drew.")

WORLDS, ROUNDS = 40, 10  # four worlds of each kind; a fault of one round in a hundred shows in 400
Names = Annotated[str, typer.Option(help="Only these, separated by commas; default: all.")]


@app.callback()
def suite() -> None:
    """Keep `generated` a command of its own."""


@app.command()
def generated(
    split: Annotated[
        str, typer.Option(help="development to build with, validation to judge.")
    ] = "validation",
    worlds: Annotated[int, typer.Option(min=1, help="How many, kinds and sizes in turn.")] = WORLDS,
    rounds: Annotated[int, typer.Option(min=0, help="Of hide and seek, before and after.")] = ROUNDS,
    kinds: Names = "",
    sizes: Names = "",
    profile: options.ProfileName = None,
    pipeline: options.PipelineName = None,
    max_steps: options.MaxSteps = 1500,
    jobs: Annotated[int, typer.Option(min=1, help="Worlds at a time.")] = 1,
    cluster: Annotated[
        str | None, typer.Option(help="Dask scheduler, for example tcp://10.0.0.5:8786.")
    ] = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Explore generated worlds, find hidden robots there, and once more after people moved the furniture.

    What is done is kept: a suite that was cut off goes on. Rounds that fail leave a recording each.
    """
    from experiments.generated.plan import plan_worlds
    from experiments.generated.suite import GeneratedSuite, run_generated
    from experiments.hide_and_seek.plan import folder_of
    from services.launcher.client.run_record import keep_run

    started = datetime.now(UTC)
    only = _listed(kinds), _listed(sizes)
    plans = plan_worlds(split, worlds, rounds, max_steps, *only, pipeline, profile)
    folder = data_dir / "generated" / folder_of(split, pipeline, profile)
    chosen = GeneratedSuite(split, plans, folder, jobs, cluster)
    result = run_generated(chosen, json_file)
    keep_run(
        data_dir,
        f"suite generated --split {split}",
        started,
        {**result["summary"], "outcome": "succeeded"},
        worlds=[plan.name for plan in plans],
        json_file=json_file,
    )


def _listed(names: str) -> list[str]:
    return [name.strip() for name in names.split(",") if name.strip()]
