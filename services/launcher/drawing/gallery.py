"""A page of generated worlds: plan, panorama and figures of each."""

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape
from pathlib import Path

STYLE = (
    "body{font:15px system-ui,sans-serif;margin:2rem auto;max-width:76rem;padding:0 1rem;color:#222}"
    "article{display:grid;grid-template-columns:1fr 2fr;gap:0 1rem;margin:0 0 2rem;border-top:1px solid #ccc}"
    "h2{grid-column:1/-1;font-size:1.05rem;margin:.6rem 0}img{width:100%;height:auto}p{margin:.3rem 0}"
    "@media(max-width:50rem){article{grid-template-columns:1fr}}"
)


@dataclass(frozen=True)
class Exhibit:
    """One world of the page.

    Attributes:
        name: of its files, which lie beside the page: `.yaml`, `.png` (plan) and `.jpg` (panorama).
        split: what the world is for.
        figures: its size and what is free, for people.
    """

    name: str
    split: str
    figures: str


def write_page(folder: Path, exhibits: Iterable[Exhibit]) -> Path:
    """Write the page beside the files of its worlds."""
    articles = "\n".join(_article(exhibit) for exhibit in exhibits)
    page = folder / "index.html"
    page.write_text(
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Generated worlds</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style>'
        f"<main><h1>Generated worlds</h1>\n{articles}\n</main></html>\n",
        encoding="utf-8",
    )
    return page


def _article(exhibit: Exhibit) -> str:
    name = escape(exhibit.name)
    return (
        f'<article><h2><a href="{name}.yaml">{name}</a>, '
        f"{escape(exhibit.split)}: {escape(exhibit.figures)}</h2>"
        f'<img loading="lazy" src="{name}.png" alt="plan of {name}">'
        f'<img loading="lazy" src="{name}.jpg" alt="what the robot sees at the start of {name}"></article>'
    )
