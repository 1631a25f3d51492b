"""The two kinds of work of a suite: explore a world, play its rounds. Each starts a stack of its own.

Both are plain functions of values, so that a process pool or a cluster can run them. A map travels from one
to the other as the bytes of its files.
"""

import json
import shutil
from pathlib import Path
from typing import Any

import httpx

from experiments.bench.listener import Listener
from experiments.bench.resources import peak_memory_mb
from experiments.bench.stages import stage_durations_ms, table
from experiments.hide_and_seek.plan import MAP_SEED, MapPlan, RunPlan
from experiments.hide_and_seek.play import Scene, play_rounds
from experiments.hide_and_seek.report import report
from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import post_archive, store_client
from services.launcher.client.stack import Stack, StackChoice, open_stack
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

ARCHIVE, TRUTH, FIGURES = "map.zip", "truth.json", "explore.json"
MapFiles = dict[str, bytes]
"""By name: what `topnav map export` writes, the truth file, and what `topnav explore --json` has."""


def make_map(plan: MapPlan, folder: str) -> MapFiles:
    """Explore a world once; a map that is there already is taken.

    Args:
        plan: which map.
        folder: where maps are kept, and the stack's files while it runs.

    Raises:
        ExperimentError: the exploration did not end by itself.
    """
    files = map_or_part(plan, folder)
    explored = json.loads(files[FIGURES])
    if explored["outcome"] != "succeeded":
        # The next try explores again.
        shutil.rmtree(Path(folder) / plan.label, ignore_errors=True)
        raise ExperimentError(f"exploring {plan.world}: {explored['outcome']}: {explored['reason']}")
    return files


def map_or_part(plan: MapPlan, folder: str) -> MapFiles:
    """The same, of an exploration that was given up as well."""
    own = Path(folder) / plan.label
    if not (own / FIGURES).exists():
        _explore(plan, own)
    return {name: (own / name).read_bytes() for name in (ARCHIVE, TRUTH, FIGURES)}


def _explore(plan: MapPlan, own: Path) -> None:
    """Write the files of a map into a folder; the figures come last and mark it as whole."""
    data_dir = own / "stack"
    shutil.rmtree(data_dir, ignore_errors=True)
    choice = StackChoice(
        data_dir, plan.world, MAP_SEED, lockstep=True, profile=plan.profile, pipeline=plan.pipeline
    )
    with open_stack(choice) as stack:
        result = explore(stack, plan.world, MAP, MAP_SEED, EXPLORE_STEPS)
        with _store(stack) as store:
            archive = store.get(f"/maps/{MAP}/export").raise_for_status().content
        memory = peak_memory_mb(stack.launcher)
    (own / ARCHIVE).write_bytes(archive)
    save_truth(own / TRUTH, MAP, result.truth)
    told = figures(result, free_space(load_world(plan.world)), MAP, MAP_SEED)
    per_node = round(len(archive) / max(1, len(result.graph.nodes)))
    write_json(own / FIGURES, {**told, "bytes_per_node": per_node, "memory_mb": memory})


def play_run(plan: RunPlan, files: MapFiles, folder: str) -> dict[str, Any]:
    """Play the rounds of a run; those that an earlier try finished are kept.

    Args:
        plan: what to play.
        files: of the map to play on.
        folder: of the suite; the run gets its own folder there.

    Returns:
        The object of `topnav hide-and-seek --json`, with stages and memory.
    """
    own = Path(folder) / plan.name
    record, data_dir = own / "rounds.json", own / "stack"
    rounds: list[dict[str, Any]] = json.loads(record.read_text())["rounds"] if record.exists() else []
    path, fresh = truth_path(data_dir, MAP), not rounds
    if fresh:
        shutil.rmtree(data_dir, ignore_errors=True)
        data_dir.mkdir(parents=True)
        path.write_bytes(files[TRUTH])
    if len(rounds) < plan.rounds:
        choice = StackChoice(
            data_dir, plan.world, plan.seed, lockstep=True, profile=plan.profile, pipeline=plan.pipeline
        )
        scene = Scene(load_world(plan.world), MAP, load_truth(path))
        with open_stack(choice) as stack:
            if fresh:
                with _store(stack) as store:
                    post_archive(store, files[ARCHIVE], MAP)
            with Listener(stack.address, stack.robot, most=TIMED_MESSAGES) as listener:
                drawings = own if plan.draw else None
                recordings = own if plan.record else None
                played = play_rounds(
                    stack,
                    scene,
                    plan.rounds,
                    plan.seed,
                    plan.max_steps,
                    drawings,
                    rounds,
                    recordings=recordings,
                    quiet=True,
                )
                for one in played:
                    rounds.append(one)
                    write_json(record, report(plan.world, plan.profile, plan.seed, rounds))
            stages, memory = table(stage_durations_ms(listener.arrivals)), peak_memory_mb(stack.launcher)
        told = report(plan.world, plan.profile, plan.seed, rounds)
        write_json(record, {**told, "pipeline": plan.pipeline, "stages": stages, "memory_mb": memory})
    whole: dict[str, Any] = json.loads(record.read_text())
    return whole


def _store(stack: Stack) -> httpx.Client:
    if stack.launcher is None:
        raise ExperimentError("suites start stacks of their own: stop the one in this folder first")
    launcher = stack.launcher
    return store_client(launcher.map_store_url, launcher.certs, launcher.settings.data_dir)
