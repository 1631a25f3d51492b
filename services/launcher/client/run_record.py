"""What a command leaves in `runs/` of the data folder, for the list of runs in the console."""

import functools
import os
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from experiments.hide_and_seek.plan import world_label
from services.launcher.evaluation.report import summary
from services.launcher.terminal import options
from services.launcher.terminal.tables import wide_console
from shared.runs import CommandRun, Figure

EXPLORE_SHOWN = ("nodes", "edges", "coverage", "collisions", "false_edges", "steps", "steps_per_s", "outcome")
MAX_NUMBER = 1000

Figures = Mapping[str, Any]


def keep_run(
    data_dir: Path,
    command: str,
    started: datetime,
    figures: Mapping[str, Figure],
    *,
    worlds: Sequence[str] = (),
    map_name: str | None = None,
    seed: int | None = None,
    json_file: Path | None = None,
) -> None:
    """Write the record of a run that ends now; where that fails, the run counts all the same.

    Args:
        data_dir: of the stack.
        command: words after `topnav`.
        started: when it began, with its zone.
        figures: those worth a line.
        worlds: names or paths.
        map_name: the map that was made or used, if any.
        seed: of the random draws.
        json_file: where the full figures are.
    """
    folder = data_dir / CommandRun.FOLDER
    try:
        run = CommandRun(
            command=command,
            started=started,
            ended=datetime.now(UTC),
            world=", ".join(map(world_label, worlds)),
            map=map_name,
            seed=seed,
            figures=dict(figures),
            file=str(json_file.resolve()) if json_file is not None else None,
        )
        _write(folder, run)
    except (OSError, ValueError) as error:
        wide_console(stderr=True).print(f"no record of this run in {folder}: {error}", highlight=False)


def explore_figures(report: Figures) -> dict[str, Figure]:
    """Of what `topnav explore --json` writes."""
    return {name: report[name] for name in EXPLORE_SHOWN}


def rounds_figures(rounds: Sequence[Figures]) -> dict[str, Figure]:
    """Of rounds of hide and seek; without any found the command fails."""
    found, told = sum(bool(one["success"]) for one in rounds), summary(rounds)
    shown = {name: told[name] for name in ("final_distance_median_m", "spl_mean", "collisions")}
    return {"rounds": len(rounds), "found": found, **shown, "outcome": "succeeded" if found else "failed"}


def suite_figures(runs: Sequence[Figures]) -> dict[str, Figure]:
    """Of all rounds of a suite; several profiles are told apart by name."""
    profiles = list(dict.fromkeys(str(run["profile"]) for run in runs))
    told: dict[str, Figure] = {}
    for profile in profiles:
        figures = rounds_figures([one for run in runs if run["profile"] == profile for one in run["rounds"]])
        del figures["outcome"]
        before = f"{Path(profile).stem}: " if len(profiles) > 1 else ""
        told |= {before + name: value for name, value in figures.items()}
    return told


def on_record(command: str, study: Callable[..., int]) -> Callable[..., None]:
    """The same command with a record at its end; `study` returns the number of its results."""

    @functools.wraps(study)
    def run(**chosen: Any) -> None:
        started = datetime.now(UTC)
        results = study(**chosen)
        world = chosen.get("world")
        keep_run(
            chosen.get("data_dir") or Path(os.environ.get("TOPNAV_DATA_DIR") or options.DATA_DIR),
            command,
            started,
            {"study": command.split()[-1], "results": results},
            worlds=[world] if world else [],
            map_name=chosen.get("map_name"),
            seed=chosen.get("seed"),
            json_file=chosen.get("json_file"),
        )

    return run


def _write(folder: Path, run: CommandRun) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    name = Path(run.file_name)
    for number in range(MAX_NUMBER):
        path = folder / (name if number == 0 else f"{name.stem}-{number}.json")
        try:
            with path.open("x", encoding="utf-8") as file:
                file.write(run.model_dump_json(indent=2) + "\n")
        except FileExistsError:
            continue
        return
    raise FileExistsError(f"{name} and {MAX_NUMBER - 1} numbered ones exist")
