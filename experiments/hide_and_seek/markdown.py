"""The result of a suite for people. Pure."""

from collections.abc import Mapping, Sequence
from typing import Any

from experiments.hide_and_seek.plan import world_label
from experiments.studies.page import markdown_table

ROUND_COLUMNS = {
    "world": "world",
    "profile": "profile",
    "found": "found",
    "final_distance_median_m": "median left (m)",
    "spl_mean": "SPL",
    "path_ratio_median": "way / shortest",
    "steps_mean": "steps",
    "collisions": "collisions",
    "manual_moves": "moved by hand",
    "edges_suspended": "edges suspended",
    "steps_per_s": "steps/s",
    "render_share": "rendering",
    "memory_mb": "memory (MB)",
}
MAP_COLUMNS = {
    "world": "world",
    "nodes": "places",
    "edges": "edges",
    "coverage": "coverage",
    "components": "parts",
    "false_edges": "false edges",
    "collisions": "collisions",
    "manual_moves": "moved by hand",
    "steps": "steps",
    "s_per_node": "s per place",
    "kb_per_node": "kB per place",
}


def suite_markdown(suite: str, maps: Sequence[Mapping[str, Any]], runs: Sequence[Mapping[str, Any]]) -> str:
    """Tables of maps, runs, and rounds that failed."""
    lines = [
        f"# Suite {suite}",
        "",
        "## Rounds",
        "",
        *markdown_table(ROUND_COLUMNS, [run_row(run) for run in runs]),
    ]
    lines += ["", "## Maps", "", *markdown_table(MAP_COLUMNS, [map_row(one) for one in maps])]
    failed = [
        f"- {world_label(run['world'])}, {run['profile']}, round {number}: {one['reason']} "
        f"({one['final_distance_m']:.2f} m left)"
        for run in runs
        for number, one in enumerate(run["rounds"], 1)
        if not one["success"]
    ]
    return "\n".join([*lines, *(["", "## Not found", "", *failed] if failed else []), ""])


def run_row(run: Mapping[str, Any]) -> dict[str, Any]:
    """One run as a row."""
    summary, stages = run["summary"], run.get("stages", {})
    total_ms = sum(stage["p50_ms"] for stage in stages.values())
    rendering = stages.get("render", {}).get("p50_ms", 0.0) / total_ms if total_ms else None
    found = sum(bool(one["success"]) for one in run["rounds"])
    return {
        **summary,
        "world": world_label(run["world"]),
        "profile": run["profile"],
        "found": f"{found}/{summary['rounds']}",
        "render_share": f"{rendering:.0%}" if rendering is not None else "",
        "memory_mb": round(sum(run.get("memory_mb", {}).values())) or "",
    }


def map_row(one: Mapping[str, Any]) -> dict[str, Any]:
    """One exploration as a row."""
    nodes = max(1, one["nodes"])
    figures = {"s_per_node": one["wall_s"] / nodes, "kb_per_node": one["bytes_per_node"] / 1000}
    return {**one, **figures, "world": world_label(one["world"])}
