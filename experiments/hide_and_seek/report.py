"""What rounds and suites come to: figures as --json writes them, rows for people, a page. Pure."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from experiments.work.page import markdown_table
from services.launcher.client.environments import robot_base
from services.launcher.client.run_record import world_label
from services.launcher.terminal.output import rounded

Figures = Mapping[str, Any]


def report(world: str, profile: str, seed: int, rounds: Sequence[Figures]) -> dict[str, Any]:
    """The object of `topnav hide-and-seek --json`; the keys of the summary up to steps_per_s are fixed."""
    return {
        "world": world,
        "profile": profile,
        "seed": seed,
        "base": robot_base(),
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
        "wrong_place": sum(r["failure"] == "wrong_place" for r in rounds),
        "ambiguous": sum(r["failure"] == "ambiguous" for r in rounds),
    }


def combined(runs: Sequence[Figures]) -> dict[str, Any]:
    """The summary of all runs of each profile."""
    return {profile: summary(rounds) for profile, rounds in _by_profile(runs).items()}


def rounds_figures(rounds: Sequence[Figures]) -> dict[str, Any]:
    """What the console's list of runs shows of rounds; without any found the command fails."""
    found, whole = sum(bool(one["success"]) for one in rounds), summary(rounds)
    shown = {name: whole[name] for name in ("final_distance_median_m", "spl_mean", "collisions")}
    return {"rounds": len(rounds), "found": found, **shown, "outcome": "succeeded" if found else "failed"}


def suite_figures(runs: Sequence[Figures]) -> dict[str, Any]:
    """The same of all rounds of a suite; several profiles are told apart by name."""
    by_profile = _by_profile(runs)
    shown: dict[str, Any] = {}
    for profile, rounds in by_profile.items():
        figures = rounds_figures(rounds)
        del figures["outcome"]
        before = f"{Path(profile).stem}: " if len(by_profile) > 1 else ""
        shown |= {before + name: value for name, value in figures.items()}
    return shown


def suite_markdown(suite: str, maps: Sequence[Figures], runs: Sequence[Figures]) -> str:
    """Tables of maps, runs, and rounds that failed."""
    rounds, explored = [run_row(run) for run in runs], [map_row(one) for one in maps]
    lines = [f"# Suite {suite}", "", "## Rounds", "", *markdown_table(rounds)]
    lines += ["", "## Maps", "", *markdown_table(explored)]
    failed = [
        f"- {world_label(run['world'])}, {run['profile']}, round {number}: {one['reason']} "
        f"({one['final_distance_m']:.2f} m left)"
        for run in runs
        for number, one in enumerate(run["rounds"], 1)
        if not one["success"]
    ]
    return "\n".join([*lines, *(["", "## Not found", "", *failed] if failed else []), ""])


def run_row(run: Figures) -> dict[str, Any]:
    """One run as a row for people."""
    total, stages = run["summary"], run.get("stages", {})
    total_ms = sum(stage["p50_ms"] for stage in stages.values())
    rendering = stages.get("render", {}).get("p50_ms", 0.0) / total_ms if total_ms else None
    return {
        "world": world_label(run["world"]),
        "profile": run["profile"],
        "found": f"{sum(bool(one['success']) for one in run['rounds'])}/{total['rounds']}",
        "median left (m)": total["final_distance_median_m"],
        "SPL": total["spl_mean"],
        "way / shortest": total["path_ratio_median"],
        "steps": total["steps_mean"],
        "collisions": total["collisions"],
        "moved by hand": total["manual_moves"],
        "edges suspended": total["edges_suspended"],
        "wrong place": total["wrong_place"],
        "ambiguous": total["ambiguous"],
        "steps/s": total["steps_per_s"],
        "rendering": f"{rendering:.0%}" if rendering is not None else "",
        "memory (MB)": round(sum(run.get("memory_mb", {}).values())) or "",
    }


def map_row(one: Figures) -> dict[str, Any]:
    """One exploration as a row for people."""
    same = {name: one[name] for name in ("nodes", "edges", "coverage")}
    return {
        "world": world_label(one["world"]),
        **same,
        "parts": one["components"],
        "false edges": one["false_edges"],
        "collisions": one["collisions"],
        "moved by hand": one["manual_moves"],
        "steps": one["steps"],
        "s per node": one["wall_s"] / max(1, one["nodes"]),
        "kB per node": one["bytes_per_node"] / 1000,
    }


def _by_profile(runs: Sequence[Figures]) -> dict[str, list[Figures]]:
    rounds: dict[str, list[Figures]] = {}
    for run in runs:
        rounds.setdefault(str(run["profile"]), []).extend(run["rounds"])
    return rounds
