"""Figures as tables for the shell."""

from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table

PIPE_WIDTH = 160
"""Columns where there is no terminal to ask, for example in a log file."""


def print_figures(title: str, figures: Mapping[str, object]) -> None:
    """One row per plain figure; lists and nested figures stay in the JSON."""
    table = Table(title=title, show_header=False)
    for name, value in figures.items():
        if isinstance(value, str | int | float) or value is None:
            table.add_row(name, f"{value:g}" if isinstance(value, float) else str(value))
    wide_console().print(table)


def print_rows(title: str, rows: Sequence[Mapping[str, object]]) -> None:
    """One column per key of the first row."""
    table = Table(title=title)
    for name in rows[0] if rows else ():
        table.add_column(name)
    for row in rows:
        table.add_row(*(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()))
    wide_console().print(table)


def wide_console(*, stderr: bool = False) -> Console:
    """A console that does not break lines where nobody looks at a terminal."""
    console = Console(stderr=stderr)
    return console if console.is_terminal else Console(stderr=stderr, width=PIPE_WIDTH)
