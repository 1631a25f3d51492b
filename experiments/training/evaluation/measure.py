"""The same pairs for every model: matches against exact correspondences, answers, times."""

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from experiments.rendered.pairs import PosePair
from experiments.training.correspondences import correspondences
from experiments.training.data.shards import Pair
from experiments.training.evaluation.models import Model
from experiments.training.keypoints.measure import answer
from experiments.training.keypoints.tables import figures
from experiments.training.sights import CameraPose
from services.launcher.terminal.output import rounded
from shared.messages.simulation import Pose

OVERLAPPING = 0.05
"""Share of the directions that both see, below which a pair shows different places; chosen."""
VERIFIED_M = (2.0, 3.0)

Row = dict[str, Any]


def judge(model: Model, pairs: Sequence[Pair]) -> Row:
    """A model's entry of "models"; pairs of different places count as false answers only."""
    answers, frame_s, pair_s = [], [], []
    for pair in pairs:
        begin = time.perf_counter()
        first, second = model.features(pair.here.picture), model.features(pair.there.picture)
        frame_s.append((time.perf_counter() - begin) / 2.0)
        truth = correspondences(first.lonlat_rad, second.lonlat_rad, pair.here, pair.there)
        begin = time.perf_counter()
        (matched,) = model.pipeline.matcher.match(first, [second])
        pair_s.append(time.perf_counter() - begin)
        row = answer(first, second, matched, truth, _poses(pair), model.pipeline)
        same = max(pair.overlap) >= OVERLAPPING
        answers.append(row | {"distance_m": pair.distance_m, "same": same})
    return {
        "name": model.name,
        "bytes": model.size_bytes,
        "ms_frame": rounded(1e3 * np.median(frame_s), 1),
        "ms_pair": rounded(1e3 * np.median(pair_s), 2),
        **summary(answers),
    }


def as_written(row: Row, photographs: Row | None) -> Row:
    """A model's entry as `topnav train evaluate --json` writes it: figures by what they were taken on."""
    of_model = ("name", "bytes", "ms_frame", "ms_pair")
    return {key: row[key] for key in of_model} | {
        "renderings": {key: value for key, value in row.items() if key not in of_model},
        "photographs": photographs,
    }


def summary(answers: Sequence[Row]) -> Row:
    """Figures of pairs of the same place, and how many of other places were answered."""
    same = [row for row in answers if row["same"]]
    others = [row for row in answers if not row["same"]]
    wide = [row["verified_right"] for row in same if VERIFIED_M[0] <= row["distance_m"] <= VERIFIED_M[1]]
    whole = figures(same) if same else {}
    return {
        **whole,
        "verified_2_3_m": rounded(np.mean(wide), 1) if wide else None,
        "pairs_2_3_m": len(wide),
        "other_places": len(others),
        "other_places_answered": sum(row["answered"] for row in others),
    }


def _poses(pair: Pair) -> PosePair:
    return PosePair(_pose(pair.here.pose), _pose(pair.there.pose))


def _pose(pose: CameraPose) -> Pose:
    return Pose(x_m=pose.x_m, y_m=pose.y_m, yaw_rad=pose.yaw_rad)
