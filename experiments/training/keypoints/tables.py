"""Rows of pairs to the two tables: shares that recur, and answers with SIFT's keypoints. Pure."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from experiments.training.keypoints.measure import BANDS_M, ORACLE_ON
from services.launcher.terminal.output import rounded

Row = dict[str, Any]


def recurrence_table(rows: Sequence[Row], detectors: Sequence[str]) -> list[Row]:
    """A row per detector and distance: mean counts, and the share of visible keypoints that recur."""
    table = []
    for detector in detectors:
        own = [row for row in rows if row["detector"] == detector]
        for low, high in BANDS_M if own else ():
            inside = [row for row in own if low <= row["distance_m"] <= high]
            if not inside:
                continue
            visible = sum(row["visible"] for row in inside)
            table.append(
                {"detector": detector, "distance_m": (low + high) / 2, "pairs": len(inside)}
                | {
                    name: rounded(np.mean([row[name] for row in inside]), 1)
                    for name in ("keypoints", "visible", "recurring")
                }
                | {
                    "recurring_share": _share(sum(row["recurring"] for row in inside), visible),
                    "chance_share": _share(sum(row["by_chance"] for row in inside), visible),
                }
            )
        if not own:
            table.append({"detector": detector, "status": "no weights"})
    return table


def answer_table(rows: Sequence[Row]) -> list[Row]:
    """A row per matcher and distance: matches, precision, recall, verified ones, answers, heading error."""
    table = []
    for matcher in ("matcher", "oracle"):
        for low, high in BANDS_M:
            inside = [
                row[matcher]
                for row in rows
                if row["detector"] == ORACLE_ON and low <= row["distance_m"] <= high
            ]
            if inside:
                table.append(
                    {
                        "matcher": "mutual ratio" if matcher == "matcher" else matcher,
                        "distance_m": (low + high) / 2,
                    }
                    | figures(inside)
                )
    return table


def figures(answers: Sequence[Row]) -> Row:
    """What a number of answered questions come to."""
    off = [one["heading_off_deg"] for one in answers if one["heading_off_deg"] is not None]
    right = sum(one["right"] for one in answers)
    return {
        "pairs": len(answers),
        "matches": rounded(np.mean([one["matches"] for one in answers]), 1),
        "precision": _share(right, sum(one["matches"] for one in answers)),
        "recall": _share(right, sum(one["possible"] for one in answers)),
        "verified": rounded(np.mean([one["verified"] for one in answers]), 1),
        "verified_right": rounded(np.mean([one["verified_right"] for one in answers]), 1),
        "answered": rounded(np.mean([one["answered"] for one in answers]), 3),
        "heading_median_deg": rounded(np.median(off), 3) if off else None,
        "heading_off_20_deg": sum(one > 20.0 for one in off),
    }


def _share(part: int, whole: int) -> float | None:
    return rounded(part / whole, 3) if whole else None
