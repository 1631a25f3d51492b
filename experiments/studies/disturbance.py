"""`topnav study disturbance`: hide and seek on a clean map while camera and world are disturbed."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from experiments.plots.curves import draw_curves
from experiments.studies.disturbance_results import CLEAN, settings_to_run, summary
from experiments.studies.results_file import ResultsFile, Row
from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.map_client import require_map
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.rounds import Game, hiding_place
from services.launcher.processes.state import StateFolder
from services.launcher.terminal import options
from services.launcher.terminal.progress import mission_progress
from services.launcher.terminal.tables import print_rows, wide_console
from simulator.disturbances.levels import Disturbances
from simulator.disturbances.rearranging import rearranged
from simulator.world.changes import changed_world
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world

LEVELS = "0,0.33,0.66,1"
SHOWN = (
    "disturbance",
    "level",
    "success_rate",
    "spl_mean",
    "rounds",
    "final_distance_m_median",
    "collisions",
    "failures",
)


@dataclass(frozen=True)
class Study:
    """What all levels share."""

    world: str
    map_name: str
    rounds: int
    seed: int
    max_steps: int
    data_dir: Path


def main(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    only: Annotated[
        str | None, typer.Option(help='Disturbances to study, as "fog,noise"; default: all.')
    ] = None,
    levels: Annotated[str, typer.Option(help="Levels from 0 to 1; 0 is run once for all.")] = LEVELS,
    rounds: Annotated[int, typer.Option(min=1, help="Hiders to find at each level, the same at all.")] = 10,
    seed: options.Seed = 1,
    max_steps: options.MaxSteps = 1500,
    json_file: options.JsonFile = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the curves into this PNG.")] = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Success and SPL against the level of each disturbance; goes on where --json F stopped.

    The map must have been made in clean conditions. 0.5 is the middle level. Every level gets a stack of its
    own, and the same rounds from the same seeds.
    """
    names, numbers = _names(only), _numbers(levels)
    if StateFolder(data_dir.resolve()).read() is not None:
        raise ExperimentError("a stack runs there: stop it ('topnav down'), every level needs its own")
    study = Study(world, map_name, rounds, seed, max_steps, data_dir)
    setup: Row = {"world": world, "map": map_name, "seed": seed, "rounds": rounds, "max_steps": max_steps}
    found = ResultsFile(json_file, setup)
    for setting in settings_to_run(names, numbers, found.results):
        with one_line_errors():
            found.add(run_level(study, setting["disturbance"], setting["level"]))
        if plot is not None:
            draw_curves(plot, found.results, CLEAN)
    if plot is not None:
        draw_curves(plot, found.results, CLEAN)
    print_rows(
        f"disturbances in {world}, seed {seed}",
        [{name: row[name] for name in SHOWN} for row in found.results],
    )
    return len(found.results)


def run_level(study: Study, disturbance: str, level: float) -> Row:
    """Start a stack with one disturbance at a level and play the rounds."""
    levels = Disturbances() if disturbance == CLEAN else Disturbances.model_validate({disturbance: level})
    console = wide_console(stderr=True)
    choice = StackChoice(
        study.data_dir,
        study.world,
        study.seed,
        lockstep=True,
        environment={"SIMULATOR_DISTURBANCE": levels.text()},
    )
    clean = load_world(study.world)
    space, mapped = free_space(true_world(clean, levels, study.seed)), free_space(clean)
    # Where furniture stood while the map was made, no place of the map need be near.
    hideouts = replace(space, free=space.free & mapped.free)
    rng = np.random.default_rng(study.seed)
    played: list[dict[str, Any]] = []
    with open_stack(choice) as stack:
        require_map(stack, study.map_name)
        game = Game(stack, space, study.map_name, rng)
        game.begin(study.seed)
        for number in range(1, study.rounds + 1):
            with mission_progress(console, f"{disturbance} {level:g}: {number}/{study.rounds}") as watch:
                start = game.hand.settled_truth().pose
                hider = hiding_place(hideouts, start, rng)
                one = game.seek(start, hider, study.seed + number, study.max_steps, watch)
            played.append(one.figures())
            end = "found" if one.success else one.figures()["failure"]
            console.print(f"{disturbance} {level:g} round {number}: {end}, {one.distance_m:.2f} m left")
    return summary(disturbance, level, played)


def true_world(world: WorldFile, levels: Disturbances, seed: int) -> WorldFile:
    """The world as the simulator has it: hiders must not be put into furniture that was moved."""
    return changed_world(world, rearranged(world, levels.furniture, seed))


def _names(only: str | None) -> list[str]:
    known = list(Disturbances.model_fields)
    if only is None:
        return known
    names = [name.strip() for name in only.split(",") if name.strip()]
    unknown = sorted(set(names) - set(known))
    if unknown or not names:
        raise ExperimentError(f"--only must name some of {', '.join(known)}; got {only!r}")
    return names


def _numbers(levels: str) -> list[float]:
    try:
        numbers = [float(level) for level in levels.split(",")]
    except ValueError as error:
        raise ExperimentError(f'--levels must be numbers as "{LEVELS}", got {levels!r}') from error
    if not all(0.0 <= number <= 1.0 for number in numbers):
        raise ExperimentError(f"--levels must lie from 0 to 1, got {levels!r}")
    return numbers
