"""A study as one Markdown page beside its figures, and how these look."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

SERIES = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000")
"""Colours that stay apart for colour-blind readers (Okabe and Ito 2008)."""

MARKERS = "osD^vP*<>"


def new_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure that makes room for its labels by itself."""
    return Figure(figsize=(width_in, height_in), layout="constrained")


def line_style(number: int) -> dict[str, Any]:
    """Colour and marker of the curve with this number; 63 differ."""
    colour, marker = SERIES[number % len(SERIES)], MARKERS[number % len(MARKERS)]
    return {"color": colour, "marker": marker, "markersize": 4}


def write_page(
    folder: Path,
    name: str,
    title: str,
    command: str,
    tables: Sequence[tuple[str, Sequence[Mapping[str, object]]]],
    figures: Sequence[tuple[str, str]],
) -> Path:
    """Write `folder/name`.md.

    Args:
        folder: where the figures lie.
        name: file name without its ending.
        title: headline.
        command: what made it, for whoever wants it again.
        tables: headline and rows; columns are the keys of the first row.
        figures: caption and file name; those that are not there are left out.

    Returns:
        The page.
    """
    lines = [f"# {title}", "", f"Made by `{command}`.", ""]
    for headline, rows in tables:
        if rows:
            lines += [f"## {headline}", "", *markdown_table(rows), ""]
    for caption, file in figures:
        if (folder / file).exists():
            lines += [f"![{caption}]({file})", "", f"*{caption}*", ""]
    page = folder / f"{name}.md"
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text("\n".join(lines), encoding="utf-8")
    return page


def markdown_table(rows: Sequence[Mapping[str, object]]) -> list[str]:
    """Lines of a table; columns are the keys of the first row, and what another lacks stays empty."""
    columns = list(rows[0])
    head = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return head + ["| " + " | ".join(_cell(row.get(key)) for key in columns) + " |" for row in rows]


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value).replace("|", "\\|")
