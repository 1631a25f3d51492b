"""Figures as tables for the shell."""

from collections.abc import Mapping, Sequence

from rich.table import Table


def figure_table(title: str, figures: Mapping[str, object]) -> Table:
    """One row per plain figure; lists and nested figures stay in the JSON."""
    table = Table(title=title, show_header=False)
    for name, value in figures.items():
        if isinstance(value, str | int | float) or value is None:
            table.add_row(name, f"{value:g}" if isinstance(value, float) else str(value))
    return table


def row_table(title: str, rows: Sequence[Mapping[str, object]]) -> Table:
    """One column per key of the first row."""
    table = Table(title=title)
    for name in rows[0] if rows else ():
        table.add_column(name)
    for row in rows:
        table.add_row(*(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()))
    return table
