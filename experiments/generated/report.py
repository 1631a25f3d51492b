"""What a suite of generated worlds comes to: figures, rows for people, a page. Pure."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from experiments.generated.plan import COVERED
from experiments.work.page import markdown_table
from services.launcher.terminal.output import rounded

Figures = Mapping[str, Any]
WHEN = {"rounds": "as mapped", "moved": "rearranged"}


def summary(worlds: Sequence[Figures]) -> dict[str, Any]:
    """The object "summary"; worlds whose stack failed count as not covered and not ended."""
    whole = [one for one in worlds if "error" not in one]
    rounds, moved = _all(whole, "rounds"), _all(whole, "moved")
    over = [one["metres"] / one["peer_metres"] for one in whole if one["metres"] and one["peer_metres"]]
    return {
        "worlds": len(worlds),
        "coverage_ok": sum(one["coverage"] >= COVERED for one in whole),
        "ended": sum(one["ended"] for one in whole),
        "edges": sum(one["edges"] for one in whole),
        "false_edges": sum(one["false_edges"] for one in whole),
        "without_false_edges": sum(one["false_edges"] == 0 for one in whole),
        "collisions": sum(one["collisions"] for one in (*whole, *rounds, *moved)),
        "rounds": len(rounds),
        "success_rate": _share(rounds),
        "spl_mean": _of(np.mean, [one["spl"] for one in rounds]),
        "final_distance_median_m": _of(np.median, [one["final_distance_m"] for one in rounds]),
        "wrong_place": sum(one["failure"] == "wrong_place" for one in (*rounds, *moved)),
        "moved_rounds": len(moved),
        "moved_success_rate": _share(moved),
        "metres_over_peer_median": _of(np.median, over),
        "errors": len(worlds) - len(whole),
    }


def world_table_row(one: Figures) -> dict[str, Any]:
    """A world as a row for people."""
    name = f"{one['kind']}-{one['seed']}-{one['size']}"
    if "error" in one:
        return {"world": name, "coverage": one["error"]}
    return {
        "world": name,
        "free (m2)": one["area_m2"],
        "coverage": one["coverage"],
        "ended": one["ended"],
        "nodes": one["nodes"],
        "edges": one["edges"],
        "false": one["false_edges"],
        "collisions": one["collisions"],
        "driven (m)": one["driven_m"],
        "to 97 % (m)": one["metres"],
        "frontier peer (m)": one["peer_metres"],
        "random walk (m)": one["walk_metres"],
        "found": _found(one["rounds"]),
        "found later": _found(one["moved"]),
    }


def page(split: str, worlds: Sequence[Figures], total: Figures) -> str:
    """Tables of worlds and of the whole, and what failed by its cause."""
    lines = [f"# Generated worlds, {split}", "", *markdown_table([total]), "", "## Worlds", ""]
    lines += markdown_table([world_table_row(one) for one in worlds]) if worlds else []
    for cause, cases in sorted(failures(worlds).items(), key=lambda item: -len(item[1])):
        lines += ["", f"## {cause}: {len(cases)}", "", *(f"- {case}" for case in cases)]
    return "\n".join([*lines, ""])


def failures(worlds: Iterable[Figures]) -> dict[str, list[str]]:
    """What went wrong by its cause, each with the recording to look at."""
    found: dict[str, list[str]] = defaultdict(list)
    for one in worlds:
        name = f"{one['kind']}-{one['seed']}-{one['size']}"
        for cause, text in _in_map(one) if "error" not in one else [("stack failed", one["error"])]:
            found[cause].append(f"{name}: {text}")
        for when, world in (("rounds", name), ("moved", f"{name}-rearranged")):
            for number, played in enumerate(one.get(when, ()), 1):
                recording = f"{name}/{world}-default-1/round-{number:02d}.mcap"
                for cause, text in _in_round(played):
                    found[f"{cause} ({WHEN[when]})"].append(f"{text}: {recording}")
    return dict(found)


def _in_map(one: Figures) -> list[tuple[str, str]]:
    faults = [
        (not one["ended"], "exploration did not end by itself", one["reason"]),
        (one["coverage"] < COVERED, "coverage", f"{one['coverage']:.3f}"),
        (one["false_edges"], "false edges", f"{one['false_edges']} of {one['edges']}"),
        (one["collisions"], "collision while exploring", f"{one['collisions']}"),
    ]
    return [(cause, text) for there, cause, text in faults if there]


def _in_round(played: Figures) -> list[tuple[str, str]]:
    left = f"{played['reason']}, {played['final_distance_m']:.2f} m left"
    faults = [(not played["success"], played["failure"], left), (played["collisions"], "collision", left)]
    return [(cause, text) for there, cause, text in faults if there]


def _all(worlds: Iterable[Figures], key: str) -> list[Figures]:
    return [played for one in worlds for played in one[key]]


def _share(rounds: Sequence[Figures]) -> float | None:
    return rounded(sum(bool(one["success"]) for one in rounds) / len(rounds)) if rounds else None


def _of(statistic: Any, values: Sequence[float]) -> float | None:
    return rounded(statistic(values)) if len(values) else None


def _found(rounds: Sequence[Figures]) -> str:
    return f"{sum(bool(one['success']) for one in rounds)}/{len(rounds)}"
