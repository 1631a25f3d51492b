"""`topnav hide-and-seek`: the thesis's evaluation, rounds of finding a hidden robot from its picture."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from experiments import options
from experiments.drawings import draw_round
from experiments.environments import environment_of
from experiments.failure import ExperimentError, one_line_errors
from experiments.map_client import require_map
from experiments.output import new_run_folder, rounded, write_json
from experiments.progress import mission_progress
from experiments.rounds import Game, Round
from experiments.stack import Stack, StackChoice, open_stack
from experiments.tables import print_rows, wide_console
from experiments.truth_file import MapTruth, load_truth, truth_path
from simulator.freespace import free_space
from simulator.world_file import WorldFile, load_world

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)

SHOWN = ("success", "final_distance_m", "spl", "steps", "collisions", "shortest_m", "driven_m", "reason")


@dataclass(frozen=True)
class Scene:
    """Where the rounds take place; `truth` is for the drawings only."""

    world: WorldFile
    map_name: str
    truth: MapTruth | None


@app.command()
def main(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    rounds: Annotated[int, typer.Option(min=1, help="How many hiders to find.")] = 20,
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
) -> None:
    """Find robots that hide at random places, one after the other, from the pictures they send."""
    choice = StackChoice(data_dir, world, seed, lockstep, profile, pipeline, endpoint)
    scene = Scene(load_world(world), map_name, load_truth(truth_path(data_dir, map_name)))
    folder = (drawings or new_run_folder(options.RUNS_DIR)) if draw else None
    played: list[Round] = []
    with one_line_errors(), open_stack(choice) as stack:
        for one in play_rounds(stack, scene, rounds, seed, max_steps, folder):
            played.append(one)
            if json_file is not None:
                write_json(json_file, report(world, profile or "default", seed, played))
    rows = [{name: r.figures()[name] for name in SHOWN} for r in played]
    print_rows(f"hide and seek in {world}, seed {seed}", rows)
    print_rows("summary", [report(world, profile or "default", seed, played)["summary"]])
    if not any(r.success for r in played):
        raise ExperimentError("no round succeeded")


def play_rounds(
    stack: Stack, scene: Scene, rounds: int, seed: int, max_steps: int, folder: Path | None
) -> Iterator[Round]:
    """Play one round after the other; the seeker stays where the last one ended."""
    console = wide_console(stderr=True)
    graph = require_map(stack, scene.map_name)
    arrived_m = environment_of(scene.world).arrived_m
    game = Game(stack, free_space(scene.world), scene.map_name, np.random.default_rng(seed), arrived_m)
    game.begin(seed)
    poses = scene.truth.poses if scene.truth is not None else {}
    for number in range(1, rounds + 1):
        with mission_progress(console, f"round {number}/{rounds}") as watch:
            played = game.play(seed + number, max_steps, watch)
        console.print(_line(number, played), highlight=False)
        if folder is not None:
            draw_round(folder / f"round-{number:02d}", scene.world, played, poses, graph.edges, game)
        yield played


def report(world: str, profile: str, seed: int, played: list[Round]) -> dict[str, Any]:
    """The figures of --json; the keys of the summary up to steps_per_s are fixed."""
    rounds = [r.figures() for r in played]
    steps, wall_s = sum(r.run.status.step for r in played), sum(r.run.wall_s for r in played)
    summary = {
        "rounds": len(rounds),
        "success_rate": rounded(np.mean([r.success for r in played])),
        "collisions": sum(int(str(r["collisions"])) for r in rounds),
        "manual_moves": sum(int(str(r["manual_moves"])) for r in rounds),
        "spl_mean": rounded(np.mean([r.spl for r in played])),
        "final_distance_median_m": rounded(np.median([r.distance_m for r in played])),
        "steps_per_s": rounded(steps / max(wall_s, 1e-9), 2),
    }
    return {"world": world, "profile": profile, "seed": seed, "rounds": rounds, "summary": summary}


def _line(number: int, played: Round) -> str:
    verdict = "found" if played.success else "NOT found"
    return (
        f"round {number}: {verdict}, {played.distance_m:.2f} m left, SPL {played.spl:.2f}, "
        f"{played.run.status.step} steps, {played.run.steps_per_s:.1f} steps/s: {played.run.status.reason}"
    )
