"""`topnav suite generated`: play in many worlds that nobody drew, and tell what came of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from experiments.generated.job import ROW, play_or_tell
from experiments.generated.plan import WorldPlan
from experiments.generated.report import page, summary, world_table_row
from experiments.work.follow import follow
from experiments.work.workers import workers
from services.launcher.terminal.output import print_rows, wide_console, write_json

SHOWN = (
    "world",
    "coverage",
    "false",
    "collisions",
    "to 97 % (m)",
    "frontier peer (m)",
    "found",
    "found later",
)


@dataclass(frozen=True)
class GeneratedSuite:
    """What a suite is asked for.

    Attributes:
        split: of the worlds.
        plans: all worlds.
        folder: keeps worlds, maps, rounds and recordings; a suite that was cut off goes on from there.
        jobs: worlds at a time on this machine.
        cluster: address of a Dask scheduler, or None.
    """

    split: str
    plans: Sequence[WorldPlan]
    folder: Path
    jobs: int = 1
    cluster: str | None = None


def run_generated(suite: GeneratedSuite, json_file: Path | None) -> dict[str, Any]:
    """Run a suite; writes suite.json and summary.md into its folder.

    Returns:
        {"split", "worlds", "summary"}.
    """
    folder = suite.folder.resolve()
    rows = [folder / plan.name / ROW for plan in suite.plans]
    play = partial(play_or_tell, folder=str(folder))
    with workers(suite.jobs, suite.cluster) as pool:
        jobs = [pool.submit(play, plan) for plan in suite.plans]
        done = partial(_count, rows)
        follow(wide_console(stderr=True), f"worlds of {suite.split}", jobs, len(jobs), done)
    worlds = [job.result() for job in jobs]
    total = summary(worlds)
    result = {"split": suite.split, "worlds": worlds, "summary": total}
    write_json(folder / "suite.json", result)
    write_json(json_file, result)
    text = page(suite.split, worlds, total)
    (folder / "summary.md").write_text(text, encoding="utf-8")
    print_rows(f"generated worlds: {folder / 'summary.md'}", [world_table_row(one) for one in worlds], SHOWN)
    return result


def _count(rows: Sequence[Path]) -> int:
    return sum(row.exists() for row in rows)
