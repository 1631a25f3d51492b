"""What a pipeline sees of a world from any pose, in this process: no stack is needed."""

import hashlib
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from services.features.matching.verification import feature_set
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.settings import CameraSettings, SimulationSettings
from simulator.world.world_file import WorldFile

WIDTH_PX = 1024


def camera_settings() -> SimulationSettings:
    """The camera of the running stack: docker-compose.yml sets the same width."""
    return SimulationSettings(camera=CameraSettings(width_px=WIDTH_PX))


def cache_folder(root: Path, kind: str, world: WorldFile, pipeline: Pipeline, *choices: object) -> Path:
    """Where pictures of one kind are kept: another world, camera, pipeline or choice is another folder."""
    camera = camera_settings().camera
    parts = (world.model_dump_json(), camera.model_dump_json(), asdict(pipeline.profile), *choices)
    text = "|".join(str(part) for part in parts)
    return root / f"{kind}-{world.name}-{pipeline.identity}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"


def camera(world: WorldFile) -> Callable[[Pose], Frame]:
    """The frame of a world from any pose; loads SAPIEN, so call it where a picture is missing."""
    from simulator.simulation import Simulation

    simulation = Simulation(world, camera_settings())

    def shoot(pose: Pose) -> Frame:
        picture = simulation.panorama_at(pose.x_m, pose.y_m, pose.yaw_rad)
        height, width = picture.shape[:2]
        return Frame(robot="study", encoding="bgr8", width_px=width, height_px=height, data=picture.tobytes())

    return shoot


def eye(world: WorldFile, pipeline: Pipeline) -> Callable[[Pose], FeatureSet]:
    """What the pipeline sees of a world from any pose; loads SAPIEN as `camera` does."""
    shoot = camera(world)
    return lambda pose: feature_set(pipeline.features_of(shoot(pose)))
