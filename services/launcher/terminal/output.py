"""Figures and files of a run on disk."""

import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np


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
