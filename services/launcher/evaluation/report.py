"""Figures of rounds, as --json writes them. Pure."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from services.launcher.terminal.output import rounded

Figures = Mapping[str, Any]


def report(world: str, profile: str, seed: int, rounds: Sequence[Figures]) -> dict[str, Any]:
    """The object of `topnav hide-and-seek --json`; the keys of the summary up to steps_per_s are fixed."""
    return {
        "world": world,
        "profile": profile,
        "seed": seed,
        "rounds": list(rounds),
        "summary": summary(rounds),
    }


def summary(rounds: Sequence[Figures]) -> dict[str, Any]:
    """What a number of rounds comes to."""
    found = [r for r in rounds if r["success"]]
    return {
        "rounds": len(rounds),
        "success_rate": rounded(len(found) / len(rounds)),
        "collisions": sum(int(r["collisions"]) for r in rounds),
        "manual_moves": sum(int(r["manual_moves"]) for r in rounds),
        "spl_mean": rounded(np.mean([r["spl"] for r in rounds])),
        "final_distance_median_m": rounded(np.median([r["final_distance_m"] for r in rounds])),
        "steps_per_s": rounded(
            sum(r["steps"] for r in rounds) / max(sum(r["wall_s"] for r in rounds), 1e-9), 2
        ),
        "steps_mean": rounded(np.mean([r["steps"] for r in rounds]), 1),
        "path_ratio_median": rounded(np.median([r["path_ratio"] for r in found]), 3) if found else None,
        "edges_suspended": sum(int(r["edges_suspended"]) for r in rounds),
    }


def combined(runs: Sequence[Figures]) -> dict[str, Any]:
    """The summary of all runs of each profile."""
    profiles = dict.fromkeys(str(run["profile"]) for run in runs)
    return {
        profile: summary([r for run in runs if run["profile"] == profile for r in run["rounds"]])
        for profile in profiles
    }
