"""`topnav study disturbance-matches`: disturbed frames against clean ones, and render times."""

import math
import time
from typing import Annotated, Any

import numpy as np
import typer

from experiments.studies.disturbance_results import CLEAN
from experiments.studies.rendered_views import WIDTH_PX
from services.features.matching.verification import Candidate, feature_set, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.terminal import options
from services.launcher.terminal.output import rounded, write_json
from services.launcher.terminal.tables import print_rows
from shared.messages.sensors import Frame
from simulator.disturbances.levels import Disturbances
from simulator.service_settings import user_cache_dir
from simulator.settings import CameraSettings, SimulationSettings
from simulator.simulation import Image, Simulation
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import WorldFile, load_world

APART_M = 1.0
SPEED_MPS = 0.4
TIMED = 6
Pose2 = tuple[float, float, float]
Row = dict[str, Any]


def main(
    world: options.World = "apartment",
    levels: Annotated[str, typer.Option(help="Levels from 0 to 1.")] = "0.5,1",
    pairs: Annotated[int, typer.Option(min=1, help="Pairs of poses 1 m apart.")] = 20,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
) -> int:
    """What each disturbance leaves of the verified matches between frames 1 m apart, and what it costs."""
    scene, feature_pipeline = load_world(world), Pipeline(find_profile(pipeline or "sift"))
    poses = poses_apart(free_space(scene), pairs, np.random.default_rng(seed))
    clean = _simulation(scene, Disturbances(), seed)
    targets = [_features(clean.panorama_at(*target), feature_pipeline) for _, target in poses]
    settings = [(CLEAN, 0.0)] + [
        (name, float(level)) for name in Disturbances.model_fields for level in levels.split(",")
    ]
    rows: list[Row] = []
    for name, level in settings:
        disturbed = Disturbances() if name == CLEAN else Disturbances.model_validate({name: level})
        simulation = _simulation(scene, disturbed, seed)
        row = measure(simulation, poses, targets, feature_pipeline)
        rows.append(
            {"disturbance": name, "level": level, **row, "render_ratio": render_ratio(simulation, clean)}
        )
        if json_file is not None:
            write_json(json_file, {"world": world, "seed": seed, "pairs": pairs, "results": rows})
    print_rows(f"frames {APART_M:g} m apart in {world}", rows)
    return len(rows)


def measure(
    simulation: Simulation, poses: list[tuple[Pose2, Pose2]], targets: list[FeatureSet], pipeline: Pipeline
) -> Row:
    """Medians over all pairs; the disturbed camera moves towards the other pose."""
    inliers, errors = [], []
    for number, ((current, target), clean) in enumerate(zip(poses, targets, strict=True)):
        way_rad = math.atan2(target[1] - current[1], target[0] - current[0])
        motion = (SPEED_MPS * math.cos(way_rad), SPEED_MPS * math.sin(way_rad), 0.0)
        seen = _features(simulation.panorama_at(*current, motion), pipeline)
        (matched,) = pipeline.matcher.match(seen, [clean])
        result = verify(seen, Candidate(0, clean), matched, number, pipeline.verification, False)
        inliers.append(result.inliers)
        if result.heading_rad is not None:
            errors.append(abs(math.remainder(result.heading_rad - (way_rad - current[2]), math.tau)))
    return {
        "verified_median": rounded(np.median(inliers), 1),
        "verified_least": int(min(inliers)),
        "with_direction": rounded(len(errors) / len(poses), 3),
        "heading_error_deg_median": rounded(math.degrees(np.median(errors)), 2) if errors else None,
    }


def render_ratio(simulation: Simulation, clean: Simulation) -> float:
    """Time of a picture in motion over that of the clean simulation, taken in turns."""
    spent = [0.0, 0.0]
    start = simulation.world.start
    for number in range(TIMED):
        for which, one in enumerate((simulation, clean)):
            began_s = time.perf_counter()
            one.panorama_at(start.x_m, start.y_m, 0.1 * number, (SPEED_MPS, 0.0, 0.0))
            spent[which] += time.perf_counter() - began_s if number else 0.0
    return rounded(spent[0] / spent[1], 2)


def poses_apart(space: FreeSpace, count: int, rng: np.random.Generator) -> list[tuple[Pose2, Pose2]]:
    """Pairs of free poses APART_M apart that see each other."""
    found: list[tuple[Pose2, Pose2]] = []
    for _ in range(200 * count):
        if len(found) == count:
            return found
        x_m, y_m, yaw_rad = space.random_pose(rng)
        bearing, other_rad = (float(angle) for angle in rng.uniform(-math.pi, math.pi, 2))
        end = (x_m + APART_M * math.cos(bearing), y_m + APART_M * math.sin(bearing))
        if space.is_free(end) and space.line_of_sight((x_m, y_m), end):
            found.append(((x_m, y_m, yaw_rad), (*end, other_rad)))
    raise ValueError(f"the free floor has no room for {count} pairs {APART_M} m apart; ask for fewer")


def _simulation(world: WorldFile, levels: Disturbances, seed: int) -> Simulation:
    camera = CameraSettings(width_px=WIDTH_PX)
    cache_dir = user_cache_dir()
    return Simulation(
        world, SimulationSettings(camera=camera, cache_dir=cache_dir, disturbances=levels), seed
    )


def _features(picture: Image, pipeline: Pipeline) -> FeatureSet:
    height, width = picture.shape[:2]
    frame = Frame(robot="study", encoding="bgr8", width_px=width, height_px=height, data=picture.tobytes())
    return feature_set(pipeline.features_of(frame))
