"""The rendered scene with all that moves, and what disturbs the camera."""

import numpy as np
import numpy.typing as npt
import sapien

from simulator.disturbances.blur import Motion, mean_picture, poses_of
from simulator.disturbances.camera import Moment, degraded
from simulator.disturbances.fog import fog_of
from simulator.disturbances.illumination import body_brightness, illuminated, view_brightness
from simulator.disturbances.people import Figure
from simulator.robot.physics_scene import Bodies
from simulator.robot.robot_shape import HIDER, SEEKER, link_parts, whole_robot
from simulator.scene.disk_cache import DiskCache
from simulator.scene.painter import Painter
from simulator.scene.parts import Contents, Pose2
from simulator.scene.render_scene import RenderScene
from simulator.sensors.attitude import Quaternion
from simulator.sensors.panorama import Image
from simulator.settings import SimulationSettings
from simulator.world.world_file import WorldFile


class View:
    """Takes pictures of a world from anywhere."""

    def __init__(
        self, world: WorldFile, contents: Contents, settings: SimulationSettings, figures: list[Figure]
    ) -> None:
        """Build everything that can be seen.

        Args:
            world: the world file.
            contents: its parts and lights, see world.contents.expand.
            settings: camera, robot, cache and levels of the disturbances.
            figures: people, carts and other robots, in the order in which `Bodies` has their poses.
        """
        self._settings, self._levels, self._figures = settings, settings.disturbances, figures
        self._cache = DiskCache(settings.cache_dir, settings.cache_limit_mb * 1_000_000)
        level = self._levels.illumination
        shown, lit = illuminated(world, contents, level)
        with Painter(self._cache) as painter:
            sky = view_brightness(level)
            self._scene = RenderScene(shown, lit, settings.camera, painter, self._cache, sky)
            self._add_bodies()
        self._add_fog(world)
        self._cache.tidy()

    def change(self, world: WorldFile, contents: Contents) -> None:
        """Show another state of the world."""
        with Painter(self._cache) as painter:
            self._change(world, contents, painter)

    def set_light(self, illumination: float, world: WorldFile, contents: Contents) -> None:
        """Show the same world at another time of day, from noon (0) to lamps only (1)."""
        self._levels = self._levels.model_copy(update={"illumination": illumination})
        for body in (*self._links.values(), self._hider, *self._walkers):
            self._scene.remove_body(body)
        with Painter(self._cache) as painter:
            self._change(world, contents, painter)
            self._add_bodies()
        self._add_fog(world)

    def picture(
        self, camera: Pose2, motion: Motion, lean: Quaternion, bodies: Bodies, moment: Moment
    ) -> Image:
        """What a camera that moves and leans like this sees, (height, width, 3) BGR."""
        self._scene.move_flat(self._hider, bodies.hider)
        for entity, pose in zip(self._walkers, bodies.walkers, strict=True):
            self._scene.move_flat(entity, pose)
        pictures = []
        for pose in poses_of(camera, motion, self._levels.blur):
            self._place_robot(bodies, pose[0] - camera[0], pose[1] - camera[1])
            pictures.append(self._scene.panorama(pose, lean))
        return degraded(mean_picture(pictures), self._levels, moment)

    def measured(
        self, camera: Pose2, lean: Quaternion, bodies: Bodies
    ) -> tuple[Image, npt.NDArray[np.float32]]:
        """The same of a camera at rest that nothing disturbs, and metres along the ray of each pixel."""
        self._scene.move_flat(self._hider, bodies.hider)
        for entity, pose in zip(self._walkers, bodies.walkers, strict=True):
            self._scene.move_flat(entity, pose)
        self._place_robot(bodies, 0.0, 0.0)
        return self._scene.measured_panorama(camera, lean)

    def _change(self, world: WorldFile, contents: Contents, painter: Painter) -> None:
        level = self._levels.illumination
        shown, lit = illuminated(world, contents, level)
        self._scene.change_static(shown, lit, painter, self._cache, view_brightness(level))

    def _add_bodies(self) -> None:
        """Everything that moves, as bright as it is at this time of day."""
        robot, shade = self._settings.robot, body_brightness(self._levels.illumination)
        looks = link_parts(robot, SEEKER)
        self._links = {name: self._scene.add_body(parts, shade) for name, parts in looks.items()}
        self._hider = self._scene.add_body(whole_robot(robot, HIDER), shade)
        self._walkers = [self._scene.add_body(figure.looks, shade) for figure in self._figures]

    def _add_fog(self, world: WorldFile) -> None:
        levels = self._levels
        fog = fog_of(levels.fog, levels.rain, levels.illumination, world.environment)
        self._scene.set_fog(fog.extinction, fog.grey)

    def _place_robot(self, bodies: Bodies, dx_m: float, dy_m: float) -> None:
        """Put the robot's links where they were, which during an exposure is a little further back."""
        for name, entity in self._links.items():
            pose = bodies.links[name]
            if dx_m or dy_m:
                pose = sapien.Pose([pose.p[0] + dx_m, pose.p[1] + dy_m, pose.p[2]], pose.q)
            self._scene.move(entity, pose)
