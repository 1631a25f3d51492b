"""The whole simulator without any bus: world, robot, camera, sensors, truth."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simulator.disk_cache import DiskCache
from simulator.footprints import footprints
from simulator.freespace import BODY_BAND_M
from simulator.parts import Light, Part
from simulator.physics_scene import PhysicsScene
from simulator.ranges import measure, sensor_angles_rad
from simulator.scene_parts import expand
from simulator.settings import SimulationSettings
from simulator.world_file import WorldFile

Pose2 = tuple[float, float, float]
Image = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Truth:
    """What only evaluation may know."""

    x_m: float
    y_m: float
    yaw_rad: float
    hider: Pose2 | None
    time_s: float
    speed_mps: float
    collisions: int


class Simulation:
    """One world, one robot, perhaps a hider. Same seed, poses and commands give bit-identical results."""

    def __init__(self, world: WorldFile, settings: SimulationSettings | None = None, seed: int = 0) -> None:
        """Build the world; the robot stands at the world's start."""
        self.world = world
        self.settings = settings or SimulationSettings()
        self._parts, lights = expand(world)
        self._shapes = footprints(self._parts, *BODY_BAND_M)
        self._view = _View(world, (self._parts, lights), self.settings) if self.settings.render else None
        self._hider: Pose2 | None = None
        self.reset(seed)

    def reset(self, seed: int, pose: Pose2 | None = None) -> None:
        """Start anew: time 0, no collisions, robot at rest at `pose` (else the start). The hider stays."""
        start = self.world.start
        self._seed = seed
        self._readings = 0
        self._build(pose or (start.x_m, start.y_m, math.radians(start.yaw_deg)), 0.0, 0)

    def place_robot(self, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Put the robot elsewhere, at rest; time and the collision count go on."""
        self._build((x_m, y_m, yaw_rad), self._physics.time_s, self._physics.collisions)

    def place_hider(self, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Put the second robot somewhere; it is only seen, nothing bumps into it."""
        self._hider = (x_m, y_m, yaw_rad)

    def remove_hider(self) -> None:
        """Take the second robot away."""
        self._hider = None

    def command(self, steer_rad: float, wheel_speed_radps: float, ttl_s: float = math.inf) -> None:
        """Roll towards a heading (robot frame) at a wheel speed for up to `ttl_s` of simulated time."""
        if not (math.isfinite(steer_rad) and math.isfinite(wheel_speed_radps)) or ttl_s < 0:
            raise ValueError(
                f"command must be finite with ttl_s >= 0, got {steer_rad}, {wheel_speed_radps}, {ttl_s}"
            )
        self._physics.robot.command(steer_rad, wheel_speed_radps)
        self._expires_s = self._physics.time_s + ttl_s

    def stop(self) -> None:
        """Stop the wheels."""
        self._physics.robot.command(0.0, 0.0)

    def step(self, duration_s: float) -> None:
        """Advance physics by a whole number of timesteps, at least one."""
        for _ in range(max(1, round(duration_s / self.settings.timestep_s))):
            if self._physics.time_s >= self._expires_s - 1e-9:
                self.stop()
            self._physics.step()

    def panorama(self) -> Image:
        """What the robot's camera sees, (height, width, 3) BGR."""
        return self.panorama_at(*self._physics.robot.pose())

    def panorama_at(self, x_m: float, y_m: float, yaw_rad: float) -> Image:
        """What a camera at any pose sees, with both robots where they are; (height, width, 3) BGR."""
        if self._view is None:
            raise RuntimeError(
                "this simulation was made with render=False; set SimulationSettings.render to take pictures"
            )
        return self._view.picture((x_m, y_m, yaw_rad), self._physics, self._hider)

    def ranges(self) -> npt.NDArray[np.float64]:
        """Distances of the twelve sensors, metres; every call is a new reading with its own noise."""
        rng = np.random.default_rng([self._seed, self._readings])
        self._readings += 1
        return measure(*self._physics.robot.pose(), self._shapes, self.settings.ranges, rng)

    def steer_angles_rad(self) -> list[float]:
        """Measured angles of the four steer servos."""
        return self._physics.robot.steer_angles_rad()

    def range_angles_rad(self) -> npt.NDArray[np.float64]:
        """Axes of the sensors, robot frame."""
        return sensor_angles_rad(self.settings.ranges)

    def truth(self) -> Truth:
        """True state, for evaluation only."""
        physics = self._physics
        return Truth(
            *physics.robot.pose(), self._hider, physics.time_s, physics.robot.speed_mps(), physics.collisions
        )

    def _build(self, pose: Pose2, time_s: float, collisions: int) -> None:
        self._physics = PhysicsScene(self._parts, self.settings.robot, self.settings.timestep_s, pose)
        self._physics.time_s, self._physics.collisions = time_s, collisions
        self._expires_s = math.inf


class _View:
    """The rendered scene with the bodies of both robots."""

    def __init__(
        self,
        world: WorldFile,
        contents: tuple[tuple[Part, ...], tuple[Light, ...]],
        settings: SimulationSettings,
    ) -> None:
        # SAPIEN's renderer is loaded only where pictures are wanted.
        from simulator.painter import Painter
        from simulator.render_scene import RenderScene
        from simulator.robot_shape import HIDER, SEEKER, chassis_parts, leg_parts, wheel_parts, whole_robot

        robot = settings.robot
        cache = DiskCache(settings.cache_dir, settings.cache_limit_mb * 1_000_000)
        with Painter(cache) as painter:
            self._scene = RenderScene(world, contents, settings.camera, painter, cache)
            self._links = {"chassis": self._scene.add_body(chassis_parts(robot, SEEKER))}
            for k in range(4):
                self._links[f"leg{k}"] = self._scene.add_body(leg_parts(robot))
                self._links[f"wheel{k}"] = self._scene.add_body(wheel_parts(robot))
            self._hider = self._scene.add_body(whole_robot(robot, HIDER))
        cache.tidy()

    def picture(self, camera: Pose2, physics: PhysicsScene, hider: Pose2 | None) -> Image:
        """Move the bodies to where they are and take the picture."""
        for name, entity in self._links.items():
            self._scene.move(entity, physics.robot.links[name].entity.pose)
        self._scene.move_flat(self._hider, hider)
        return self._scene.panorama(camera)
