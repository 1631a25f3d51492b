"""The whole simulator without any bus: world, robot, camera, sensors, truth."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from shared.motion.motion import NO_MOTION, Motion
from simulator.company import AWAY, company_of
from simulator.disturbances.camera import Moment
from simulator.disturbances.leaning import CameraLean
from simulator.disturbances.rearranging import rearranged
from simulator.disturbances.traction import traction_of
from simulator.disturbances.walking import Crowd, crowd_of
from simulator.robot.physics_scene import Bodies, PhysicsScene
from simulator.scene.parts import Pose2
from simulator.sensors.attitude import LEVEL, PitchRoll, Vector
from simulator.sensors.ranges import measure, sensor_angles_rad
from simulator.settings import SimulationSettings
from simulator.world.changes import ChangeError, Changes, changed_world, with_item, with_obstacle
from simulator.world.contents import expand
from simulator.world.footprints import clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, free_space
from simulator.world.world_file import WorldFile

if TYPE_CHECKING:
    from simulator.scene.view import View

Image = npt.NDArray[np.uint8]
TOUCH_M = 0.02  # chosen: less than this of a new thing inside the robot is pushed out by physics


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
        self.settings = settings or SimulationSettings()
        levels = self.settings.disturbances
        self._camera = CameraLean(self.settings)
        self._file = world
        self._changes: Changes = rearranged(world, levels.furniture, seed)
        self._show(changed_world(world, self._changes))
        self._crowd = self._gather(seed)
        self._company = company_of(self.settings.company, self.settings.robot)
        self._view = self._look_at() if self.settings.render else None
        self._hider: Pose2 | None = None
        self.reset(seed)

    def reset(self, seed: int, pose: Pose2 | None = None) -> None:
        """Start anew: time 0, no collisions, robot at rest at `pose` (else the start). The hider stays."""
        start = self.world.start
        self._seed = seed
        self._readings = 0
        self._camera.reset(seed)
        self._crowd.restart()
        self._build(pose or (start.x_m, start.y_m, math.radians(start.yaw_deg)), 0.0, 0)

    def place_robot(self, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Put the robot elsewhere, at rest; time and the collision count go on."""
        self._camera.lift()
        physics = self._physics
        self._build((x_m, y_m, yaw_rad), physics.time_s, physics.collisions, physics.robot.odometry)

    def place_hider(self, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Put the second robot somewhere; it is only seen, nothing bumps into it.

        It makes room for who finds it: where the two would stand in one another it is not seen either.
        """
        self._hider = (x_m, y_m, yaw_rad)

    def remove_hider(self) -> None:
        """Take the second robot away."""
        self._hider = None

    def tell_company(self, name: str, pose: Pose2 | None) -> None:
        """Where another robot of the place is now, seen, felt and hit there; None: nothing is heard of it.

        Raises:
            KeyError: not one of the settings' `company`.
        """
        self._company.tell(name, pose)

    def set_item(self, name: str, present: bool | None = None, pose: Pose2 | None = None) -> None:
        """Take a piece of furniture away, put it back, or move it: seen, felt and hit from now on.

        Raises:
            ChangeError: no such item, nothing to do, or it would stand in the robot.
        """
        self._change(with_item(self._file, self._changes, name, present, pose))

    def place_obstacle(self, kind: str, pose: Pose2, name: str | None = None) -> None:
        """Add a piece of furniture that the world file does not have.

        Raises:
            ChangeError: unknown kind, taken name, or it would stand in the robot.
        """
        self._change(with_obstacle(self._file, self._changes, name, kind, pose))

    def set_light(self, illumination: float) -> None:
        """Let it become another time of day, from noon (0) to lamps only (1): seen from now on."""
        if self._view is not None:
            self._view.set_light(illumination, self.world, (self._parts, self._lights))

    def command(
        self, forward_mps: float, left_mps: float = 0.0, turn_radps: float = 0.0, ttl_s: float = math.inf
    ) -> None:
        """Move like this in the robot's frame for up to `ttl_s` of simulated time."""
        if not all(map(math.isfinite, (forward_mps, left_mps, turn_radps))) or ttl_s < 0:
            raise ValueError(
                "command must be finite with ttl_s >= 0, "
                f"got {forward_mps}, {left_mps}, {turn_radps}, {ttl_s}"
            )
        traction = traction_of(self.settings.disturbances, self._seed, self._physics.time_s)
        self._physics.robot.command(forward_mps, left_mps, turn_radps, traction)
        self._expires_s = self._physics.time_s + ttl_s

    def stop(self) -> None:
        """Stop the wheels."""
        self._physics.robot.command(0.0, 0.0, 0.0)

    def step(self, duration_s: float) -> None:
        """Advance physics by a whole number of timesteps, at least one."""
        for _ in range(max(1, round(duration_s / self.settings.timestep_s))):
            if self._physics.time_s >= self._expires_s - 1e-9:
                self.stop()
            if self._walkers:
                self._walk()
            if self._fellows:
                self._follow()
            self._physics.step()
            if self.settings.disturbances.rocking:
                self._camera.advance(self._physics.robot.pose()[2], self._physics.robot.motion())

    def panorama(self) -> Image:
        """What the robot's camera sees, (height, width, 3) BGR."""
        robot = self._physics.robot
        return self._picture(robot.pose(), robot.motion(), self._camera.rocked())

    def panorama_at(
        self,
        x_m: float,
        y_m: float,
        yaw_rad: float,
        motion: Pose2 = (0.0, 0.0, 0.0),
        rocked: PitchRoll = LEVEL,
    ) -> Image:
        """What a camera at any pose sees, with both robots where they are; (height, width, 3) BGR.

        `motion` is that of the camera, world frame, m/s and rad/s: it blurs where that is on. `rocked` is the
        pitch (nose down) and roll (left up), radians, of a robot below it that rocks.
        """
        return self._picture((x_m, y_m, yaw_rad), motion, rocked)

    def measured_at(
        self, x_m: float, y_m: float, yaw_rad: float, rocked: PitchRoll = LEVEL
    ) -> tuple[Image, npt.NDArray[np.float32]]:
        """What an undisturbed camera at rest sees, and the range of each pixel; for evaluation only.

        Returns:
            (height, width, 3) BGR, and (height, width) metres along each ray; inf for nothing.
        """
        pose = (x_m, y_m, yaw_rad)
        lean = self._camera.lean(self._physics.time_s, (0.0, 0.0, 0.0), rocked)
        return self._seeing().measured(pose, lean, self._bodies())

    def rocked(self) -> PitchRoll:
        """By how much the robot rocks: pitch (nose down) and roll (left up), radians; for evaluation only."""
        return self._camera.rocked()

    def gravity(self) -> Vector | None:
        """What an IMU on the camera reads when `panorama` is taken, see `Frame`; None without an IMU."""
        robot = self._physics.robot
        time_s, rocked = self._physics.time_s, self._camera.rocked()
        return self._camera.gravity(time_s, robot.pose(), robot.motion(), rocked)

    def gravity_at(self, x_m: float, y_m: float, yaw_rad: float, rocked: PitchRoll = LEVEL) -> Vector | None:
        """The same for `panorama_at` of a camera at rest."""
        camera, still = (x_m, y_m, yaw_rad), (0.0, 0.0, 0.0)
        return self._camera.gravity(self._physics.time_s, camera, still, rocked)

    def ranges(self) -> npt.NDArray[np.float64]:
        """Distances of the twelve sensors, metres; every call is a new reading with its own noise."""
        rng = np.random.default_rng([self._seed, self._readings])
        self._readings += 1
        shapes = self._shapes.with_walkers(self._crowd.outlines()) if self._walkers else self._shapes
        shapes = shapes.with_walkers(self._company.outlines()) if self._fellows else shapes
        return measure(*self._physics.robot.pose(), shapes, self.settings.ranges, rng)

    def odometry(self) -> tuple[Motion, Motion]:
        """What the encoders of the wheels say: the way so far, and how they turn now, as that of a second."""
        return self._physics.robot.odometry, self._physics.robot.odometry_per_s

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

    def _build(self, pose: Pose2, time_s: float, collisions: int, odometry: Motion = NO_MOTION) -> None:
        self._physics = PhysicsScene(self._parts, self.settings.robot, self.settings.timestep_s, pose)
        self._physics.time_s, self._physics.collisions = time_s, collisions
        self._physics.robot.odometry = odometry
        self._expires_s = math.inf
        self._crowd.make_room(pose[:2])
        self._walkers = [self._physics.add_walker(w.figure.solid) for w in self._crowd.walkers]
        for body, walker in zip(self._walkers, self._crowd.walkers, strict=True):
            self._physics.move_walker(body, walker.pose(), at_once=True)

        self._company.withdraw(pose[:2])
        self._fellows = [self._physics.add_walker(figure.solid) for figure in self._company.figures()]
        for body, where in zip(self._fellows, self._company.poses(), strict=True):
            self._physics.move_walker(body, where or AWAY, at_once=True)

    def _follow(self) -> None:
        """The bodies of other robots go to where those are; one that appears or goes does so at once."""
        before = self._company.poses()
        self._company.advance(self.settings.timestep_s, self._physics.robot.pose()[:2])
        for body, was, where in zip(self._fellows, before, self._company.poses(), strict=True):
            self._physics.move_walker(body, where or AWAY, at_once=was is None or where is None)

    def _walk(self) -> None:
        """Everybody takes a step; physics carries the bodies there in its next step."""
        self._crowd.advance(self.settings.timestep_s, self._physics.robot.pose()[:2])
        for body, walker in zip(self._walkers, self._crowd.walkers, strict=True):
            self._physics.move_walker(body, walker.pose())

    def _show(self, world: WorldFile) -> None:
        self.world = world
        self._parts, self._lights = expand(world)
        self._shapes = footprints(self._parts, *BODY_BAND_M)

    def _gather(self, seed: int) -> Crowd:
        level, robot_m = self.settings.disturbances.people, self.settings.robot.body_radius_m
        if level == 0.0:
            return Crowd([], robot_m)
        return crowd_of(free_space(self.world), level, seed, self.settings.polite_people)

    def _look_at(self) -> "View":
        # SAPIEN's renderer is loaded only where pictures are wanted.
        from simulator.scene.view import View

        figures = [walker.figure for walker in self._crowd.walkers] + self._company.figures()
        return View(self.world, (self._parts, self._lights), self.settings, figures)

    def _picture(self, camera: Pose2, motion: Pose2, rocked: PitchRoll) -> Image:
        moment = Moment(self._seed, self._physics.time_s, camera)
        lean = self._camera.lean(self._physics.time_s, motion, rocked)
        return self._seeing().picture(camera, motion, lean, self._bodies(), moment)

    def _seeing(self) -> "View":
        if self._view is None:
            raise RuntimeError(
                "this simulation was made with render=False; set SimulationSettings.render to take pictures"
            )
        return self._view

    def _bodies(self) -> Bodies:
        links = {name: link.entity.pose for name, link in self._physics.robot.links.items()}
        walking = [walker.pose() for walker in self._crowd.walkers]
        return Bodies(links, self._seen_hider(), [*walking, *self._company.poses()])

    def _seen_hider(self) -> Pose2 | None:
        x_m, y_m, _ = self._physics.robot.pose()
        touching_m = 2.0 * self.settings.robot.body_radius_m
        if self._hider is None or math.hypot(self._hider[0] - x_m, self._hider[1] - y_m) < touching_m:
            return None
        return self._hider

    def _change(self, changes: Changes) -> None:
        """Build the changed world round the robot, which stops but stays where it is."""
        before = self._changes, self.world
        pose = self._physics.robot.pose()
        self._show(changed_world(self._file, changes))
        if clearance_m(np.array([pose[:2]]), self._shapes)[0] < self.settings.robot.body_radius_m - TOUCH_M:
            self._show(before[1])
            raise ChangeError(f"it would stand in the robot at ({pose[0]:.2f}, {pose[1]:.2f})")
        self._changes = changes
        self._crowd.block(self._shapes)
        physics = self._physics
        self._build(pose, physics.time_s, physics.collisions, physics.robot.odometry)
        if self._view is not None:
            self._view.change(self.world, (self._parts, self._lights))
