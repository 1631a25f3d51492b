"""One world of a suite: drawn, explored, played in, rearranged, played in again; a function of values."""

import json
from pathlib import Path
from typing import Any

from experiments.generated.plan import WorldPlan
from experiments.generated.row import curves_of, world_row
from experiments.hide_and_seek.jobs import FIGURES, MapFiles, map_or_part, play_run
from experiments.hide_and_seek.plan import MAP_SEED, MapPlan, RunPlan
from services.launcher.client.failure import ExperimentError
from services.launcher.drawing.curves import draw_coverage
from services.launcher.processes.wait import LaunchError
from services.launcher.terminal.output import write_json
from simulator.generation.generate import generate
from simulator.generation.mending import GenerationError
from simulator.generation.rearranged_world import rearrange_file
from simulator.generation.world_text import write_world
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

ROW, CURVES = "row.json", "coverage.png"
SHOWN = 1.5
"""Of what exploring drove, the metres drawn: a random walk goes on for long."""


def play_world(plan: WorldPlan, folder: str) -> dict[str, Any]:
    """Everything in one world; what an earlier try finished is kept.

    Args:
        plan: the world, and how many rounds.
        folder: of the suite; the world gets its own folder there, with its files, maps and recordings.

    Returns:
        An entry of "worlds" of `topnav suite generated --json`.
    """
    own = Path(folder) / plan.name
    if (own / ROW).exists():
        whole: dict[str, Any] = json.loads((own / ROW).read_text(encoding="utf-8"))
        return whole
    world, later = own / f"{plan.name}.yaml", own / f"{plan.name}-rearranged.yaml"
    if not world.exists():
        write_world(world, generate(plan.kind, plan.seed, plan.size))
    if not later.exists():
        rearrange_file(str(world), later, plan.seed)
    files = map_or_part(MapPlan(str(world), plan.pipeline, plan.profile), str(own))
    explored = json.loads(files[FIGURES])
    rounds, moved = _rounds(plan, world, files, own), _rounds(plan, later, files, own)
    drawn = load_world(str(world))
    space = free_space(drawn)
    curves = curves_of(plan, drawn, space, explored)
    row = world_row(plan, space, explored, curves, rounds, moved)
    draw_coverage(own / CURVES, plan.name, curves, SHOWN * max(explored["driven_m"], 1.0))
    write_json(own / ROW, row)
    return row


def _rounds(plan: WorldPlan, world: Path, files: MapFiles, own: Path) -> list[dict[str, Any]]:
    """Rounds on the map, in the world as it is; none if there is nothing to find the way in."""
    if json.loads(files[FIGURES])["nodes"] == 0:
        return []
    run = RunPlan(
        str(world),
        plan.profile or "default",
        plan.rounds,
        MAP_SEED,
        plan.max_steps,
        draw=False,
        record=True,
        pipeline=plan.pipeline,
        map_profile=plan.profile,
    )
    rounds: list[dict[str, Any]] = play_run(run, files, str(own))["rounds"]
    return rounds


def play_or_tell(plan: WorldPlan, folder: str) -> dict[str, Any]:
    """The same; a failure is told in the row of the world, which the next call tries again."""
    try:
        return play_world(plan, folder)
    except (ExperimentError, GenerationError, LaunchError) as error:
        return {"kind": plan.kind, "seed": plan.seed, "size": plan.size, "error": str(error)}
