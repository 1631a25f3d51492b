"""What a command leaves in `runs/` of the data folder, for the list of runs in the console."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from services.launcher.terminal.output import wide_console
from shared.runs import CommandRun

MAX_NUMBER = 1000
"""Runs that end within one second: more than any machine can do."""


def keep_run(
    data_dir: Path,
    command: str,
    started: datetime,
    figures: Mapping[str, Any],
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


def world_label(world: str) -> str:
    """A world's name as a folder or a table shows it, of a path that of its file."""
    return world.rsplit("/", 1)[-1].removesuffix(".yaml").removesuffix(".yml")


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
