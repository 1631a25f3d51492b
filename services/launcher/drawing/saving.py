"""How every drawing is written."""

from pathlib import Path

from matplotlib.figure import Figure

DPI = 130


def save(figure: Figure, path: Path) -> None:
    """Write a PNG; its folder is made where it is missing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)
