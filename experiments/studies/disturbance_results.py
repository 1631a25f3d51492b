"""Figures of the disturbance study: rounds of one level, and the file that keeps them."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from experiments.failure import ExperimentError
from experiments.output import rounded, write_json

Row = dict[str, Any]
CLEAN = "none"


def summary(disturbance: str, level: float, rounds: list[Row]) -> Row:
    """One entry of "results" from the figures of its rounds; the keys up to rounds are fixed."""
    failures = [str(one["failure"]) for one in rounds if one["failure"]]
    return {
        "disturbance": disturbance,
        "level": level,
        "success_rate": rounded(np.mean([bool(one["success"]) for one in rounds])),
        "spl_mean": rounded(np.mean([one["spl"] for one in rounds])),
        "rounds": len(rounds),
        "final_distance_m_median": rounded(np.median([one["final_distance_m"] for one in rounds])),
        "collisions": sum(int(one["collisions"]) for one in rounds),
        "failures": {name: failures.count(name) for name in sorted(set(failures))},
        "each": rounds,
    }


def settings_to_run(names: Iterable[str], levels: Iterable[float], results: list[Row]) -> list[Row]:
    """Pairs of disturbance and level without a result; level 0 is one run for all of them."""
    wanted: list[tuple[str, float]] = []
    for level in sorted(set(levels)):
        wanted += [(CLEAN, 0.0)] if level == 0.0 else [(name, level) for name in names]
    done = {(row["disturbance"], row["level"]) for row in results}
    return [{"disturbance": name, "level": level} for name, level in wanted if (name, level) not in done]


class ResultsFile:
    """A JSON file that grows by one result at a time and is gone on with when the study starts again."""

    def __init__(self, path: Path | None, setup: Row) -> None:
        """Read what an earlier run left.

        Raises:
            ExperimentError: the file is of another setup, or no file of this study.
        """
        self._path, self._setup = path, setup
        self.results: list[Row] = _read(path, setup) if path is not None and path.exists() else []

    def add(self, result: Row) -> None:
        """Keep a result."""
        self.results.append(result)
        if self._path is not None:
            write_json(self._path, {**self._setup, "results": self.results})


def _read(path: Path, setup: Row) -> list[Row]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        results: list[Row] = found["results"]
        earlier = {name: found.get(name) for name in setup}
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ExperimentError(f"{path} is no file of this study: move it away or choose another") from error
    if earlier != setup:
        raise ExperimentError(
            f"{path} was written with {earlier}, now asked for {setup}: same options, or another file"
        )
    return results
