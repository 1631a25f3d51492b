"""Disturbed frames against clean ones: what is left of the verified matches, and what rendering costs."""

import math
import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from experiments.rendered.frames import frame_of, simulated
from experiments.rendered.pairs import PosePair, draw_pair
from services.features.matching.verification import Candidate, feature_set, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.launcher.terminal.output import rounded
from simulator.disturbances.levels import UNSEEN, Disturbances, generator
from simulator.disturbances.rocking import RMS_RAD, drawn
from simulator.simulation import Image, Simulation
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile

CLEAN = "none"
APART_M = 1.0
"""Between neighbouring nodes (0.6 m) and the longest edges indoors (3 m)."""

SPEED_MPS = 0.4
"""Full speed indoors, 5 rad/s on wheels of 0.08 m: what motion blur and rolling depend on."""

TIMED = 6
"""Pictures timed, of which the first, which fills caches, does not count."""

Row = dict[str, Any]
SEEN = [name for name in Disturbances.model_fields if name not in UNSEEN]


def disturbances(name: str, level: float) -> Disturbances:
    """One disturbance at a level; CLEAN is none."""
    return Disturbances() if name == CLEAN else Disturbances.model_validate({name: level})


def measured(
    world: WorldFile, pipeline: Pipeline, levels: Sequence[float], pairs: int, seed: int
) -> Iterator[Row]:
    """A row for the clean camera, and one for each disturbance at each level."""
    rng, space = np.random.default_rng(seed), free_space(world)
    poses = [draw_pair(space, rng, APART_M) for _ in range(pairs)]
    clean = simulated(world, seed=seed)
    targets = [_features(_picture(clean, pair), pipeline) for pair in poses]
    settings = [(CLEAN, 0.0), *((name, level) for name in SEEN for level in levels)]
    for name, level in settings:
        simulation = simulated(world, disturbances=disturbances(name, level), seed=seed)
        row = _measure(simulation, poses, targets, pipeline, seed)
        ratio = _render_ratio(simulation, clean)
        yield {"disturbance": name, "level": level, **row, "render_ratio": ratio}


def _measure(
    simulation: Simulation,
    poses: Sequence[PosePair],
    targets: Sequence[FeatureSet],
    pipeline: Pipeline,
    seed: int,
) -> Row:
    """Medians over all pairs; the disturbed camera moves, and rocks, towards the other pose."""
    inliers, errors = [], []
    sigma_rad, rng = RMS_RAD * simulation.settings.disturbances.rocking, generator(seed, "rocking")
    for number, (pair, clean) in enumerate(zip(poses, targets, strict=True)):
        way_rad = pair.heading_rad + pair.current.yaw_rad
        motion = (SPEED_MPS * math.cos(way_rad), SPEED_MPS * math.sin(way_rad), 0.0)
        place = (pair.current.x_m, pair.current.y_m, pair.current.yaw_rad)
        seen = _features(simulation.panorama_at(*place, motion, drawn(sigma_rad, rng)), pipeline)
        (matched,) = pipeline.matcher.match(seen, [clean])
        result = verify(seen, Candidate(0, clean), matched, number, pipeline.verification, False)
        inliers.append(result.inliers)
        if result.heading_rad is not None:
            errors.append(abs(math.remainder(result.heading_rad - pair.heading_rad, math.tau)))
    return {
        "verified_median": rounded(np.median(inliers), 1),
        "verified_least": int(min(inliers)),
        "with_direction": rounded(len(errors) / len(poses), 3),
        "heading_error_deg_median": rounded(math.degrees(np.median(errors)), 2) if errors else None,
    }


def _render_ratio(simulation: Simulation, clean: Simulation) -> float:
    """Time of a picture in motion over that of the clean simulation, taken in turns."""
    spent = [0.0, 0.0]
    start = simulation.world.start
    for number in range(TIMED):
        for which, one in enumerate((simulation, clean)):
            began_s = time.perf_counter()
            one.panorama_at(start.x_m, start.y_m, 0.1 * number, (SPEED_MPS, 0.0, 0.0))
            spent[which] += time.perf_counter() - began_s if number else 0.0
    return rounded(spent[0] / spent[1], 2)


def _picture(simulation: Simulation, pair: PosePair) -> Image:
    return simulation.panorama_at(pair.target.x_m, pair.target.y_m, pair.target.yaw_rad)


def _features(picture: Image, pipeline: Pipeline) -> FeatureSet:
    return feature_set(pipeline.features_of(frame_of(picture)))
