"""The demo's report as Markdown, beside its pictures. Pure but for the file."""

from collections.abc import Mapping
from pathlib import Path

HEAD = """# A robot explores, remembers, and finds a picture

It has one 360-degree camera and 12 distance sensors, and never knew where it was in metres.
The drawings show true positions, which only this report has seen.
"""
PICTURES = (
    ("The map", "map.png", "Blue: places and ways between them. Yellow: walls. Grey: furniture."),
    ("The picture it was given", "goal.png", "Uploaded over HTTP, taken by the hidden robot."),
    ("The way it took", "path.png", "Green: start. Purple: via points. Red: where the picture was taken."),
    ("What the seeker saw at the end", "seeker_final.png", ""),
    ("What the hidden robot saw", "hider_final.png", ""),
)


def write_report(folder: Path, mapping: Mapping[str, object], goto: Mapping[str, object]) -> Path:
    """Write report.md and return its path."""
    parts = [HEAD, _table("Exploring", mapping), _table("Finding the hidden robot", goto)]
    parts += [f"## {title}\n\n{text}\n\n![{title}]({name})\n" for title, name, text in PICTURES]
    path = folder / "report.md"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


def _table(title: str, figures: Mapping[str, object]) -> str:
    rows = [
        f"| {name} | {value} |" for name, value in figures.items() if isinstance(value, str | int | float)
    ]
    return "\n".join([f"## {title}\n", "| figure | value |", "|---|---|", *rows, ""])
