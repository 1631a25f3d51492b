"""The two kinds of work of a suite: explore a world, play its rounds. Each starts a stack of its own.

Both are plain functions of values, so that a process pool or a cluster can run them.
"""

import json
import shutil
from pathlib import Path
from typing import Any

from experiments.bench.listener import Listener
from experiments.bench.resources import peak_memory_mb
from experiments.bench.stages import stage_durations_ms, table
from experiments.hide_and_seek.bundle import MapBundle, export_map, import_map, load_bundle, save_bundle
from experiments.hide_and_seek.plan import MAP_SEED, RunPlan
from experiments.hide_and_seek.play import Scene, play_rounds
from experiments.hide_and_seek.report import report
from services.launcher.client.failure import ExperimentError
from services.launcher.client.run_record import world_label
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore, figures
from services.launcher.evaluation.truth_file import load_truth, save_truth, truth_path
from services.launcher.terminal.output import write_json
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

MAP = "suite"
EXPLORE_STEPS = 30_000
"""Five times what the largest world takes (village: 5476, deploy/MEASURED.md)."""

TIMED_MESSAGES = 1500
"""About 300 cycles of five messages: enough for a 99th percentile, and no round more of memory."""


def make_map(world: str, folder: str) -> MapBundle:
    """Explore a world once; a bundle that is there already is taken.

    Args:
        world: name or path of the world.
        folder: where bundles are kept, and the stack's files while it runs.

    Raises:
        ExperimentError: the exploration did not end by itself.
    """
    own = Path(folder) / world_label(world)
    found = load_bundle(own)
    if found is not None:
        return found
    data_dir = own / "stack"
    shutil.rmtree(data_dir, ignore_errors=True)
    with open_stack(StackChoice(data_dir, world, MAP_SEED, lockstep=True)) as stack:
        result = explore(stack, world, MAP, MAP_SEED, EXPLORE_STEPS)
        if not result.run.succeeded:
            raise ExperimentError(f"exploring {world}: {result.run.status.state}: {result.run.status.reason}")
        archive = export_map(stack, MAP)
        memory = peak_memory_mb(stack.launcher)
    save_truth(truth_path(data_dir, MAP), MAP, result.truth)
    told = figures(result, free_space(load_world(world)), MAP, MAP_SEED)
    per_node = {"bytes_per_node": round(len(archive) / max(1, len(result.graph.nodes))), "memory_mb": memory}
    truth = truth_path(data_dir, MAP).read_text(encoding="utf-8")
    bundle = MapBundle(archive, truth, told | per_node)
    save_bundle(own, bundle)
    return bundle


def play_run(plan: RunPlan, bundle: MapBundle, folder: str) -> dict[str, Any]:
    """Play the rounds of a run; those that an earlier try finished are kept.

    Args:
        plan: what to play.
        bundle: the map to play on.
        folder: of the suite; the run gets its own folder there.

    Returns:
        The object of `topnav hide-and-seek --json`, with stages and memory.
    """
    own = Path(folder) / plan.name
    record = own / "rounds.json"
    rounds: list[dict[str, Any]] = json.loads(record.read_text())["rounds"] if record.exists() else []
    data_dir = own / "stack"
    fresh = not rounds
    if fresh:
        shutil.rmtree(data_dir, ignore_errors=True)
        path = truth_path(data_dir, MAP)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(bundle.truth, encoding="utf-8")
    extra: dict[str, Any] = {}
    if len(rounds) < plan.rounds:
        choice = StackChoice(data_dir, plan.world, plan.seed, lockstep=True, profile=plan.profile)
        scene = Scene(load_world(plan.world), MAP, load_truth(truth_path(data_dir, MAP)))
        with open_stack(choice) as stack:
            if fresh:
                import_map(stack, MAP, bundle.archive)
            with Listener(stack.address, stack.robot, most=TIMED_MESSAGES) as listener:
                drawings = own if plan.draw else None
                played = play_rounds(
                    stack, scene, plan.rounds, plan.seed, plan.max_steps, drawings, rounds, quiet=True
                )
                for one in played:
                    rounds.append(one)
                    write_json(record, report(plan.world, plan.profile, plan.seed, rounds))
            extra = {
                "stages": table(stage_durations_ms(listener.arrivals)),
                "memory_mb": peak_memory_mb(stack.launcher),
            }
        write_json(record, report(plan.world, plan.profile, plan.seed, rounds) | extra)
    whole: dict[str, Any] = json.loads(record.read_text())
    return whole
