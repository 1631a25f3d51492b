"""Pairs of tours: links, whose bearings are known, and rooms that only look alike."""

import math
from collections.abc import Iterable, Sequence

from experiments.calibration.measuring import matched, measured
from experiments.calibration.thresholds import MIN_VIA, Pair
from experiments.photographs.looks import Look, seen
from experiments.photographs.tours import Tour
from experiments.rendered.features import Tick
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError
from services.planner.mapping.edges import stands_alone
from services.planner.profiles import Profile


def pairs_of_tours(
    tours: Iterable[Tour], pipeline: Pipeline, rules: Profile, seed: int, tick: Tick
) -> tuple[list[Pair], list[int]]:
    """All links of all tours, and the matches of look-alikes that `rules` take for one place.

    Args:
        tours: the tours.
        pipeline: to measure.
        rules: the profile that thresholds are sought for; its other rules refuse most look-alikes.
        seed: of the draws.
        tick: hears how far it is.

    Raises:
        ExperimentError: no tour has a link.
    """
    lenient = rules.replaced(s_edge_min=MIN_VIA)
    links: list[Pair] = []
    look_alikes: list[int] = []
    for tour in tours:
        features = _features(tour, pipeline, tick)
        for number, (a, b, bearing_deg) in enumerate(tour.links()):
            tick(f"{tour.file.name}: link {number + 1} of {len(tour.links())}")
            bearing_rad = math.radians(bearing_deg)
            links.append(measured(features[a], features[b], bearing_rad, None, pipeline, seed + number))
        matches = [matched(features[a], features[b], pipeline, seed) for a, b in tour.look_alikes()]
        look_alikes += [match.inliers for match in matches if stands_alone(match, lenient)]
    if not links:
        raise ExperimentError(
            "expected links in a tour.json, got none: thresholds need pictures that are known to be "
            "neighbours (deploy/PHOTOGRAPHS.md)"
        )
    return links, look_alikes


def _features(tour: Tour, pipeline: Pipeline, tick: Tick) -> Sequence[FeatureSet]:
    found = []
    for number, path in enumerate(tour.paths, start=1):
        tick(f"{tour.file.name}: picture {number} of {len(tour.paths)}")
        found.append(seen(Look(path), pipeline).features)
    return found
