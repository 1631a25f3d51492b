"""All combinations on all pictures and conditions, and the table of times."""

import logging
import os
import time
from collections.abc import Callable, Iterator, Sequence

import cv2
import numpy as np

from experiments.matching.measure import PairResult, extracted, measure_pair
from experiments.matching.placing import UNCHANGED, Image
from experiments.matching.plan import MATCHERS, REPRESENTATIONS, TIMED_PX, Size, changes, profile_of
from experiments.work.results_file import ResultsFile, Row
from services.features.networks.runtime import WeightsError
from services.features.pipeline.extraction import extract
from services.features.pipeline.pipeline import Pipeline
from services.features.pipeline.plugins import CLASSIC

log = logging.getLogger(__name__)

THESIS_RATIO = {
    "superpoint": 1.12 / 0.16,
    "tfeat": 5.04 / 0.34,
    "hardnet": 5.09 / 0.34,
    "sosnet": 5.08 / 0.36,
    "hardnet8": 5.10 / 0.36,
    "mkd": 5.11 / 0.34,
    "sift": 0.97 / 0.11,
    "orb": 0.85 / 0.06,
    "beblid": 0.77 / 0.04,
}
"""Tangent over equirectangular time of table 3.1."""


def pipeline_with_weights(descriptor: str, representation: str, matcher: str) -> Pipeline | None:
    """The combination, or None where its trained weights are not here: nothing is measured without them."""
    try:
        return Pipeline(profile_of(descriptor, representation, matcher))
    except (WeightsError, ValueError, ImportError) as error:
        log.warning("%s is left out: %s", descriptor, error)
        return None


def measure_missing(
    file: ResultsFile, names: Sequence[str], sources: Sequence[Image], size: Size, tick: Callable[[str], None]
) -> None:
    """Add the rows of all descriptors that the file does not have yet; `tick` hears how far it is."""
    done = {row["descriptor"] for row in file.results}
    for name in (name for name in names if name not in done):
        rows = []
        for row in measured(name, sources, size):
            rows.append(row)
            tick(f"{name}, {row['representation']}, {row['matcher']}: {row['disturbance']}")
        file.add(*rows)


def time_missing(file: ResultsFile, names: Sequence[str], view: Image, tick: Callable[[str], None]) -> None:
    """Add the times that the file lacks, of a panorama full of texture: the view, tiled over the sphere."""
    panorama = np.asarray(cv2.resize(np.tile(view, (2, 4)), (TIMED_PX, TIMED_PX // 2)), np.uint8)
    done = {row["descriptor"] for row in file.tables["timing"]}
    done |= {row["descriptor"] for row in file.results if row["map"] is None}  # no weights here
    for name in (name for name in names if name not in done):
        tick(f"{name}: time")
        row = timed(name, panorama, 3 if name in CLASSIC else 1)
        if row is not None:
            file.add(row, table="timing")


def measured(descriptor: str, pictures: Sequence[Image], size: Size) -> Iterator[Row]:
    """Rows of one descriptor: every representation, matcher and condition, averaged over the pictures."""
    absent_before = False
    for representation in REPRESENTATIONS:
        pipeline = None if absent_before else pipeline_with_weights(descriptor, representation, MATCHERS[0])
        absent_before = pipeline is None
        names = {"descriptor": descriptor, "representation": representation}
        if pipeline is None:
            absent = {"disturbance": "none", "level": 0.0, "map": None, "time_s": None}
            yield from (
                {**names, "matcher": matcher, **absent, "weights": "no weights"} for matcher in MATCHERS
            )
            continue
        middle = [extracted(picture, UNCHANGED, pipeline, size.canvas_px) for picture in pictures]
        found: dict[tuple[str, str, float], list[PairResult]] = {}
        for change in changes(size):
            for first, picture in zip(middle, pictures, strict=True):
                second = extracted(picture, change, pipeline, size.canvas_px)
                for matcher in MATCHERS:
                    result = measure_pair(first, second, pipeline.extractor.distance, matcher)
                    found.setdefault((matcher, change.name, change.level), []).append(result)
        for (matcher, name, level), results in found.items():
            told = {"matcher": matcher, "disturbance": name, "level": level, "weights": "trained"}
            yield names | told | _mean(results)


def _mean(results: Sequence[PairResult]) -> Row:
    return {
        "map": round(float(np.mean([r.known.area for r in results])), 4),
        "map_ransac": round(float(np.mean([r.ransac.area for r in results])), 4),
        "labels_agree": round(float(np.mean([r.agreement for r in results])), 4),
        "keypoints": round(float(np.mean([r.keypoints for r in results]))),
        "time_s": round(float(np.mean([r.time_s for r in results])), 4),
    }


def timed(descriptor: str, panorama: Image, repeats: int) -> Row | None:
    """Extraction time of a whole panorama in both representations; None without weights."""
    seconds = {}
    for representation in REPRESENTATIONS:
        pipeline = pipeline_with_weights(descriptor, representation, "brute_force")
        if pipeline is None:
            return None
        taken = []
        for _ in range(repeats + 1):  # the first fills caches and tables
            begin = time.perf_counter()
            extract(panorama, pipeline.extractor, pipeline.representation, pipeline.profile)
            taken.append(time.perf_counter() - begin)
        seconds[representation] = float(np.median(taken[1:]))
    return {
        "descriptor": descriptor,
        "equirectangular_s": round(seconds["equirectangular"], 4),
        "tangent_s": round(seconds["tangent"], 4),
        "ratio": round(seconds["tangent"] / seconds["equirectangular"], 2),
        "thesis_ratio": round(THESIS_RATIO[descriptor], 1) if descriptor in THESIS_RATIO else None,
        "cores": os.cpu_count(),
    }


def tangent_wins(rows: Sequence[Row], beyond_deg: float = 45.0) -> list[Row]:
    """Per descriptor and matcher: whether tangent pictures beat the canvas away from the equator (row 46)."""
    far = [row for row in rows if row["disturbance"] == "latitude" and abs(row["level"]) >= beyond_deg]
    verdicts = []
    for name, matcher in dict.fromkeys((r["descriptor"], r["matcher"]) for r in rows if r["map"] is not None):
        of = [row for row in far if (row["descriptor"], row["matcher"]) == (name, matcher)]
        means = {
            representation: float(
                np.mean([row["map"] for row in of if row["representation"] == representation] or [np.nan])
            )
            for representation in REPRESENTATIONS
        }
        verdicts.append(
            {
                "descriptor": name,
                "matcher": matcher,
                "equirectangular": round(means["equirectangular"], 3),
                "tangent": round(means["tangent"], 3),
                "tangent_wins": means["tangent"] > means["equirectangular"],
            }
        )
    return verdicts
