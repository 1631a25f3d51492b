"""The runs of a stack: its missions and the commands that were run on it, newest first."""

import asyncio
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

from fastapi import APIRouter, Query
from pydantic import BaseModel, ValidationError

from services.gateway.live.mission_log import FILE, read_missions
from services.gateway.live.mission_watch import MissionEntry
from services.gateway.state import GatewayDep
from shared.runs import CommandRun, Figure

router = APIRouter(tags=["runs"])

MAX_FILE_BYTES = 64_000
"""Chosen: the record of a command has a few hundred."""
MAX_BROKEN = 1000
"""After so many files that cannot be read no further one is tried; chosen."""
FINISHED = "finished"


class Run(BaseModel):
    """One mission, or one run of a command.

    Attributes:
        id: unique, and the same each time it is listed.
        kind: of mission; of a command its first word, "explore", "hide-and-seek" or "study".
        title: for people.
        started: None when only the end is known.
        outcome: "succeeded", "failed", "cancelled"; "finished" for a command that does not judge itself.
        figures: a few numbers and words, by name; the seed is among them where it is known.
    """

    id: str
    source: Literal["mission", "command"]
    kind: str
    title: str
    map: str | None
    world: str | None
    started: datetime | None
    ended: datetime
    outcome: str
    figures: dict[str, Figure]


@router.get("/api/runs")
async def show_runs(gateway: GatewayDep, limit: Annotated[int, Query(ge=1, le=1000)] = 100) -> list[Run]:
    """Missions that ended and commands that were run, newest first; what cannot be read is left out."""
    runs, broken = await asyncio.to_thread(list_runs, gateway.settings.runs_dir, limit)
    gateway.metrics.runs_broken.set(broken)
    return runs


def list_runs(folder: Path, limit: int) -> tuple[list[Run], int]:
    """The newest runs of a folder, newest first, and how many lines and files could not be read."""
    try:
        missions, broken_lines = read_missions(folder / FILE)
    except OSError:
        missions, broken_lines = [], 1
    commands, broken_files = _commands(folder, limit)
    runs = newest([*map(from_mission, missions), *commands], limit)
    return runs, broken_lines + broken_files


def newest(runs: Iterable[Run], limit: int) -> list[Run]:
    """The `limit` that ended last, the last one first."""
    return sorted(runs, key=lambda run: run.ended, reverse=True)[:limit]


def from_mission(entry: MissionEntry) -> Run:
    """A mission as a run."""
    named = {"seed": entry.seed, "failure": entry.failure or None, "reason": entry.reason or None}
    return Run(
        id=f"mission:{entry.robot}:{entry.mission_id}",
        source="mission",
        kind=entry.kind,
        title=f"{entry.robot}: {entry.kind} in {entry.map}",
        map=entry.map,
        world=None,
        started=entry.started,
        ended=entry.ended,
        outcome=entry.outcome,
        figures={
            "steps": entry.steps,
            **_shown(entry),
            **{name: value for name, value in named.items() if value is not None},
        },
    )


def _shown(entry: MissionEntry) -> dict[str, Figure]:
    """What its kind shows; of an entry from before kinds said so what was kept of all."""
    if entry.figures is not None:
        return entry.figures
    return {name: getattr(entry, name) for name in ("nodes", "edges", "open_directions", "similarity")}


def from_command(name: str, run: CommandRun) -> Run:
    """A command's record as a run; `name` is its file's, without the ending."""
    seed = {} if run.seed is None else {"seed": run.seed}
    return Run(
        id=f"command:{name}",
        source="command",
        kind=run.command.split()[0],
        title=f"topnav {run.command}" + (f" in {run.world}" if run.world else ""),
        map=run.map,
        world=run.world or None,
        started=run.started,
        ended=run.ended,
        outcome=str(run.figures.get("outcome", FINISHED)),
        figures={n: value for n, value in (run.figures | seed).items() if n != "outcome"},
    )


def _commands(folder: Path, limit: int) -> tuple[list[Run], int]:
    """The newest by name, which begins with the time."""
    runs: list[Run] = []
    broken = 0
    for path in sorted(folder.glob("*.json"), reverse=True):
        if len(runs) == limit or broken == MAX_BROKEN:
            break
        run = _read(path)
        if run is None:
            broken += 1
        else:
            runs.append(from_command(path.stem, run))
    return runs, broken


def _read(path: Path) -> CommandRun | None:
    try:
        if not path.is_file() or path.stat().st_size > MAX_FILE_BYTES:
            return None
        return CommandRun.model_validate_json(path.read_bytes())
    except (OSError, ValidationError):
        return None
