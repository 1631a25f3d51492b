"""Recall and false regions of the comparison, over pairs of pictures with and without changes."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from experiments.changes.judging import Truth, Verdict
from experiments.changes.light import photographed
from experiments.changes.sights import Sight
from experiments.rendered.frames import frame_of
from services.features.changes.comparison import Sensitivity, differences
from services.features.changes.regions import regions
from services.features.changes.visits import LEAST_INLIERS, match_of
from services.features.pipeline.pipeline import Pipeline
from simulator.simulation import Image

DARK = 0.5
SHARES = (0.14, 0.16, 0.18, 0.2, 0.22, 0.25)
SIZES_SR = (0.002, 0.004)
EITHER = (0.0, 0.5, 0.6, 1.0)
NEAR_M = 0.15
LARGE_SR = 0.02

Row = dict[str, Any]


def measured(sights: Iterable[Sight], pipeline: Pipeline, rng: np.random.Generator) -> Iterator[Row]:
    """A row for every pair and setting.

    Each sight gives three pairs: what was changed, the same the other way round, and a pair without change.
    """
    for number, sight in enumerate(sights):
        nothing = np.zeros_like(sight.labels[1])
        for order, reference, current, labels in (
            ("forth", sight.before[0], sight.after[1], sight.labels[1]),
            ("back", sight.after[0], sight.before[1], sight.labels[1]),
            ("none", sight.before[0], sight.before[1], nothing),
        ):
            brightness = DARK if rng.random() < 0.5 else 1.0
            pair = photographed(reference, 1.0, rng), photographed(current, brightness, rng)
            count = len(sight.alterations) if order != "none" else 0
            told = {"sight": number, "order": order, "brightness": brightness, "offset_m": sight.offset_m}
            for row in _settings(*pair, pipeline, labels, count):
                yield told | row


def _settings(
    reference: Image, current: Image, pipeline: Pipeline, labels: Any, alterations: int
) -> Iterator[Row]:
    aligned = _aligned(reference, current, pipeline)
    if aligned is None:
        yield {"compared": False}
        return
    truth = Truth(labels, alterations)
    found = differences(reference, current, *aligned)
    for either in EITHER:
        share = found.map(either)
        for least in SHARES:
            for size_sr in SIZES_SR:
                verdict = truth.judge(regions(share, found.first_row, least, size_sr))
                setting = {"share": least, "size_sr": size_sr, "either": either}
                yield {"compared": True, **setting, **_counts(verdict)}


def _counts(verdict: Verdict) -> Row:
    large = [number for number, size_sr in verdict.sizes_sr.items() if size_sr >= LARGE_SR]
    return {
        "changes": len(verdict.by_number),
        "reported": sum(verdict.by_number.values()),
        "large": len(large),
        "large_reported": sum(verdict.by_number[number] for number in large),
        "false": len(verdict.false),
    }


def _aligned(reference: Image, current: Image, pipeline: Pipeline) -> tuple[float, float] | None:
    """Turn and disparity as the feature service finds them; None where it would not compare."""
    match = match_of(pipeline, pipeline.features_of(frame_of(current)), frame_of(reference))
    if match.yaw_rad is None or match.inliers < LEAST_INLIERS:
        return None
    return -match.yaw_rad, match.disparity_rad or 0.0


def summary(rows: Sequence[Row]) -> list[Row]:
    """A row for each setting: recall of all changes and of large ones, false regions a picture."""
    compared = [row for row in rows if row["compared"]]
    table = []
    for setting in dict.fromkeys((r["either"], r["size_sr"], r["share"]) for r in compared):
        mine = [r for r in compared if (r["either"], r["size_sr"], r["share"]) == setting]
        shown = dict(zip(("either", "size_sr", "share"), setting, strict=True))
        table.append(shown | totals(mine))
    return table


def by_conditions(rows: Sequence[Row], sensitivity: Sensitivity) -> list[Row]:
    """The same of one setting, for near and far spots, and for either light."""
    chosen = (sensitivity.share, sensitivity.size_sr, sensitivity.either)
    mine = [r for r in rows if r["compared"] and (r["share"], r["size_sr"], r["either"]) == chosen]
    conditions = {
        "all": mine,
        f"up to {NEAR_M:g} m apart": [r for r in mine if r["offset_m"] <= NEAR_M],
        f"over {NEAR_M:g} m apart": [r for r in mine if r["offset_m"] > NEAR_M],
        "same light": [r for r in mine if r["brightness"] == 1.0],
        "half the light": [r for r in mine if r["brightness"] == DARK],
        "without change": [r for r in mine if r["order"] == "none"],
    }
    return [{"pairs": name} | totals(part) for name, part in conditions.items()]


def totals(rows: Sequence[Row]) -> Row:
    """Counts, recall and false regions of these pairs."""
    sums = {key: sum(row[key] for row in rows) for key in ("changes", "reported", "large", "large_reported")}
    return {
        **sums,
        "recall": round(sums["reported"] / sums["changes"], 3) if sums["changes"] else None,
        "recall_large": round(sums["large_reported"] / sums["large"], 3) if sums["large"] else None,
        "false_per_picture": round(sum(row["false"] for row in rows) / len(rows), 3) if rows else None,
    }
