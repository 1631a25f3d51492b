"""`topnav hide-and-seek --suite`: explore what is not yet mapped, play all runs, tell the result."""

import json
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from experiments.hide_and_seek.jobs import FIGURES, MapFiles, make_map, play_run
from experiments.hide_and_seek.plan import MapPlan, RunPlan
from experiments.hide_and_seek.report import combined, run_row, suite_markdown
from experiments.work.follow import follow
from experiments.work.workers import workers
from services.launcher.terminal.output import print_rows, wide_console, write_json

SHOWN = ("world", "profile", "found", "median left (m)", "SPL", "collisions", "steps/s")

Maps = dict[MapPlan, MapFiles]


@dataclass(frozen=True)
class SuiteChoice:
    """What a suite is asked for.

    Attributes:
        plans: all runs.
        folder: keeps maps, finished rounds and drawings; a suite that was cut off goes on from there.
        jobs: runs at a time on this machine.
        cluster: address of a Dask scheduler, or None.
    """

    suite: str
    plans: Sequence[RunPlan]
    folder: Path
    jobs: int = 1
    cluster: str | None = None


def run_suite(choice: SuiteChoice, json_file: Path | None) -> dict[str, Any]:
    """Run a suite; writes suite.json and summary.md into its folder.

    Returns:
        {"suite", "runs", "summary", "maps"}.

    Raises:
        ExperimentError: a world could not be explored, or a stack failed.
    """
    console = wide_console(stderr=True)
    folder = choice.folder.resolve()
    with workers(choice.jobs, choice.cluster) as pool:
        maps = _maps(console, pool, choice, folder / "maps")
        runs = _runs(console, pool, choice, maps, folder / choice.suite)
    explored = [json.loads(files[FIGURES]) for files in maps.values()]
    result = {"suite": choice.suite, "runs": runs, "summary": combined(runs), "maps": explored}
    seed = choice.plans[0].seed
    write_json(folder / f"{choice.suite}-{seed}.json", result)
    write_json(json_file, result)
    summary = folder / f"{choice.suite}-{seed}.md"
    summary.write_text(suite_markdown(f"{choice.suite}, seed {seed}", explored, runs), encoding="utf-8")
    print_rows(f"suite {choice.suite}, seed {seed}: {summary}", [run_row(run) for run in runs], SHOWN)
    return result


def _maps(console: Console, pool: Executor, choice: SuiteChoice, folder: Path) -> Maps:
    wanted = dict.fromkeys(plan.map for plan in choice.plans)
    jobs = {plan: pool.submit(make_map, plan, str(folder)) for plan in wanted}
    follow(
        console, "worlds mapped", list(jobs.values()), len(jobs), lambda: sum(f.done() for f in jobs.values())
    )
    return {plan: job.result() for plan, job in jobs.items()}


def _runs(
    console: Console, pool: Executor, choice: SuiteChoice, maps: Maps, folder: Path
) -> list[dict[str, Any]]:
    jobs = [pool.submit(play_run, plan, maps[plan.map], str(folder)) for plan in choice.plans]
    total = sum(plan.rounds for plan in choice.plans)
    records = [folder / plan.name / "rounds.json" for plan in choice.plans]
    follow(console, "rounds played", jobs, total, lambda: sum(_on_record(record) for record in records))
    return [job.result() for job in jobs]


def _on_record(record: Path) -> int:
    """Rounds on record here; workers of a cluster keep their own until they are done."""
    return record.read_text(encoding="utf-8").count('"success":') if record.exists() else 0
