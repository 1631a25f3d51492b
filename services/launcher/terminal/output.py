"""Figures of a run: rounded, printed as tables, written to disk."""

import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

PIPE_WIDTH = 160
"""Columns where there is no terminal to ask, for example in a log file."""


def write_json(path: Path | None, figures: Mapping[str, Any]) -> None:
    """Write in one step, so that no reader ever sees half of it; None writes nothing."""
    if path is None:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    new.write_text(json.dumps(figures, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    new.replace(path)


def new_run_folder(runs: Path) -> Path:
    """Make `runs/<time>/`; a second run within the same second gets a number."""
    name = time.strftime("%Y%m%d-%H%M%S")
    for number in range(1000):
        folder = runs / (name if number == 0 else f"{name}-{number}")
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        return folder
    raise FileExistsError(f"{runs / name} and 999 numbered ones exist: clear {runs}")


def rounded(value: float | np.floating[Any], digits: int = 4) -> float:
    """A figure as it is written to JSON."""
    return round(float(value), digits)


def print_figures(title: str, figures: Mapping[str, object]) -> None:
    """One row per plain figure; lists and nested figures stay in the JSON."""
    table = Table(title=title, show_header=False)
    for name, value in figures.items():
        if isinstance(value, str | int | float) or value is None:
            table.add_row(name, f"{value:g}" if isinstance(value, float) else str(value))
    wide_console().print(table)


def print_rows(title: str, rows: Sequence[Mapping[str, object]], columns: Sequence[str] = ()) -> None:
    """One column per key of the first row, or those of `columns` alone."""
    table = Table(*(columns or (rows[0] if rows else ())), title=title)
    for row in rows:
        values = [row[name] for name in columns] if columns else list(row.values())
        table.add_row(*(f"{v:.3g}" if isinstance(v, float) else str(v) for v in values))
    wide_console().print(table)


def print_warning(text: str) -> None:
    """Print a warning beside the results; nothing where there is none."""
    if text:
        wide_console(stderr=True).print(f"[yellow]warning[/yellow] {escape(text)}", highlight=False)


def wide_console(*, stderr: bool = False) -> Console:
    """A console that does not break lines where nobody looks at a terminal."""
    console = Console(stderr=stderr)
    return console if console.is_terminal else Console(stderr=stderr, width=PIPE_WIDTH)
