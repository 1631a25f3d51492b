"""The figures of `topnav study photographs`: as they are written to JSON, and as tables for people."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.photographs.study import Found
from experiments.photographs.tables import calibration, row
from services.launcher.terminal.output import print_figures, print_rows, rounded


def report(found: Found, pipeline: str) -> dict[str, Any]:
    """All figures, as they are written to JSON."""
    rows = [
        row(one.tour.file.name, len(one.tour.paths), one.links, len(one.wrong), one.recalled)
        for one in found.tours
    ]
    wrong = sum(len(one.wrong) for one in found.tours) + len(found.foreign_wrong)
    recalled = [each for one in found.tours for each in one.recalled]
    return {
        "tours": rows,
        "total": row("total", len(found.seen), found.links, wrong, recalled),
        "foreign_pairs": {"pairs": len(found.foreign), "edges": len(found.foreign_wrong)},
        "tilt": found.tilt,
        "calibration": calibration(found.links),
        "pipeline": pipeline,
        "ms_per_picture": rounded(np.median([one.ms for one in found.seen]), 2),
        "ms_per_pair": rounded(np.median(found.ms), 2),
    }


def show(figures: Mapping[str, Any]) -> None:
    """Print what was measured: one line per tour, the total, and the same of the peer under its name."""
    rows = [*figures["tours"], figures["total"]]
    columns, peer = list(rows[0]), figures.get("peer")
    if peer is not None:
        of_peer = [
            {**one, "name": f"{one['name']}: {peer['name']}"} for one in [*peer["tours"], peer["total"]]
        ]
        rows += [{key: one.get(key, "") for key in columns} for one in of_peer]
    print_rows("links of tours", rows)
    print_rows("a tilted camera", figures["tilt"])
    print_rows("confidence of answers", figures["calibration"]["bins"])
    summary = {
        "pipeline": figures["pipeline"],
        "expected calibration error": figures["calibration"]["ece"],
        "pairs of different tours": figures["foreign_pairs"]["pairs"],
        "edges between them": figures["foreign_pairs"]["edges"],
        "ms per picture": figures["ms_per_picture"],
        "ms per pair": figures["ms_per_pair"],
    }
    if peer is not None:
        summary |= {"peer": peer["name"], "seconds of the peer, all cores": peer["total"]["seconds"]}
    print_figures("all tours", summary)
