"""`topnav hide-and-seek`: the thesis's evaluation, rounds of finding a hidden robot from its picture."""

from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from experiments.hide_and_seek.suite import SuiteChoice
    from services.launcher.client.stack import StackChoice

app = typer.Typer()

MapProfile = Annotated[
    str | None,
    typer.Option(help="Of a suite: rules by which worlds are explored, a name or a file of calibrate."),
]

SHOWN = ("success", "final_distance_m", "spl", "steps", "collisions", "shortest_m", "driven_m", "reason")
ROUNDS, SUITE_ROUNDS = 20, 25  # one failure is 5 %; 100 rounds in four worlds


@app.command("hide-and-seek")
def hide_and_seek(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    rounds: Annotated[
        int | None, typer.Option(min=1, help="How many hiders to find; default 20, of a random suite 25.")
    ] = None,
    seed: options.Seed = 1,
    lockstep: options.Lockstep = None,
    json_file: options.JsonFile = None,
    profile: options.ProfileName = None,
    pipeline: options.PipelineName = None,
    max_steps: options.MaxSteps = 1500,
    drawings: Annotated[
        Path | None, typer.Option(help="Folder for plans and final frames; default: a new one in runs/.")
    ] = None,
    draw: Annotated[bool, typer.Option(help="Draw every round.")] = True,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
    suite: Annotated[
        str | None,
        typer.Option(help="thesis: its 14 rounds; random: rounds in each of four worlds. Maps them first."),
    ] = None,
    worlds: Annotated[
        str, typer.Option(help="Of a suite: only these, separated by commas; names or .yaml files.")
    ] = "",
    map_profile: MapProfile = None,
    compare: Annotated[
        str | None, typer.Option(help="Of a suite: play everything under this profile as well.")
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Of a suite: stacks at a time.")] = 1,
    cluster: Annotated[
        str | None, typer.Option(help="Of a suite: Dask scheduler, for example tcp://10.0.0.5:8786.")
    ] = None,
) -> None:
    """Find robots that hide at random places, from the pictures they send: the thesis's evaluation."""
    from experiments.hide_and_seek.plan import plan_suite
    from experiments.hide_and_seek.suite import SuiteChoice
    from services.launcher.client.stack import StackChoice
    from services.launcher.terminal.output import new_run_folder

    if suite is None:
        choice = StackChoice(
            data_dir, world, seed, lockstep, profile, pipeline, endpoint, timeout_s=timeout_s
        )
        folder = (drawings or new_run_folder(options.RUNS_DIR)) if draw else None
        _play_rounds(choice, world, seed, map_name, rounds or ROUNDS, max_steps, folder, json_file)
        return
    plans = plan_suite(
        suite,
        seed,
        rounds=rounds or SUITE_ROUNDS,
        worlds=[name.strip() for name in worlds.split(",") if name.strip()],
        profiles=[profile or "default", *([compare] if compare else [])],
        max_steps=max_steps,
        draw=draw,
        pipeline=pipeline,
        map_profile=map_profile,
    )
    _play_suite(SuiteChoice(suite, plans, data_dir / "suites", jobs, cluster), data_dir, json_file)


def _play_rounds(
    choice: "StackChoice",
    world: str,
    seed: int,
    map_name: str,
    rounds: int,
    max_steps: int,
    folder: Path | None,
    json_file: Path | None,
) -> None:
    from experiments.hide_and_seek.play import Scene, play_rounds
    from experiments.hide_and_seek.report import report, rounds_figures
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.run_record import keep_run
    from services.launcher.client.stack import open_stack, other_world
    from services.launcher.evaluation.truth_file import load_truth, truth_path
    from services.launcher.terminal.output import print_rows, print_warning, write_json
    from simulator.world.world_file import load_world

    started = datetime.now(UTC)
    scene = Scene(load_world(world), map_name, load_truth(truth_path(choice.data_dir, map_name)))
    played: list[dict[str, Any]] = []
    told: dict[str, Any] = {}
    with open_stack(choice) as stack:
        print_warning(other_world(stack, world))
        for one in play_rounds(stack, scene, rounds, seed, max_steps, folder):
            played.append(one)
            told = report(world, choice.profile or "default", seed, played)
            write_json(json_file, told)
    keep_run(
        choice.data_dir,
        "hide-and-seek",
        started,
        rounds_figures(played),
        worlds=[world],
        map_name=map_name,
        seed=seed,
        json_file=json_file,
    )
    print_rows(f"hide and seek in {world}, seed {seed}", played, SHOWN)
    print_rows("summary", [told["summary"]])
    if not any(r["success"] for r in played):
        raise ExperimentError("no round succeeded")


def _play_suite(choice: "SuiteChoice", data_dir: Path, json_file: Path | None) -> None:
    from experiments.hide_and_seek.report import suite_figures
    from experiments.hide_and_seek.suite import run_suite
    from services.launcher.client.run_record import keep_run

    started = datetime.now(UTC)
    result = run_suite(choice, json_file)
    keep_run(
        data_dir,
        f"hide-and-seek --suite {choice.suite}",
        started,
        suite_figures(result["runs"]),
        worlds=list(dict.fromkeys(plan.world for plan in choice.plans)),
        seed=choice.plans[0].seed,
        json_file=json_file,
    )
