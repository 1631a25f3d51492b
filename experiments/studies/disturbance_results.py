"""Figures of the disturbance study: the rounds of one level, and what is still to run."""

from collections.abc import Iterable

import numpy as np

from experiments.studies.results_file import Row
from services.launcher.terminal.output import rounded

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
