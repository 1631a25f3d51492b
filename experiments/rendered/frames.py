"""What the simulated camera sees of a world from any pose, in this process: no stack is needed."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.cache_folder import user_cache_dir
from simulator.disturbances.levels import Disturbances
from simulator.sensors.attitude import LEVEL, PitchRoll
from simulator.settings import CameraSettings, SimulationSettings
from simulator.world.world_file import WorldFile

if TYPE_CHECKING:
    from simulator.simulation import Image, Simulation

WIDTH_PX = 1024
"""Of the camera in the running stack: docker-compose.yml sets the same."""

CAMERA = CameraSettings(width_px=WIDTH_PX)


def simulated(
    world: WorldFile, camera: CameraSettings = CAMERA, disturbances: Disturbances | None = None, seed: int = 0
) -> "Simulation":
    """A world to look at; loads SAPIEN, so call it where a picture is missing."""
    from simulator.simulation import Simulation

    disturbed = disturbances or Disturbances()
    settings = SimulationSettings(camera=camera, cache_dir=user_cache_dir(), disturbances=disturbed)
    return Simulation(world, settings, seed)


def camera(world: WorldFile) -> Callable[[Pose], Frame]:
    """The frame of a world from any pose; loads SAPIEN."""
    shoot = tilting_camera(world)
    return lambda pose: shoot(pose, LEVEL)


def tilting_camera(world: WorldFile) -> Callable[[Pose, PitchRoll], Frame]:
    """The frame of a world from any pose on a robot that rocks; loads SAPIEN."""
    simulation = simulated(world)
    return lambda pose, tilt: frame_of(simulation.panorama_at(pose.x_m, pose.y_m, pose.yaw_rad, rocked=tilt))


def frame_of(picture: "Image", robot: str = "study") -> Frame:
    """A panorama (H, W, 3), BGR, as the message that the feature service takes."""
    height_px, width_px = picture.shape[:2]
    return Frame(robot=robot, encoding="bgr8", width_px=width_px, height_px=height_px, data=picture.tobytes())
