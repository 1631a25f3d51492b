"""The robot in PhysX: a chassis on four legs with a steer and a drive servo each, eight joints in all."""

import math

import numpy as np
import sapien
from sapien import physx

from simulator.robot.robot_shape import wheel_mounts
from simulator.robot.steering import LegTarget, next_target
from simulator.settings import RobotSettings

# Masses, servos and friction are chosen for a robot of 18 kg that follows its commands: it rolls at 0.4 m/s
# (5 rad/s on wheels of 0.08 m), stands within a step or two, and does not push furniture or walkers.
CHASSIS_KG, LEG_KG, WHEEL_KG = 14.0, 0.5, 0.5
CHASSIS_CENTRE_M = 0.08  # low, so that it does not tip
LEG_INERTIA, WHEEL_INERTIA = 0.002, 0.0016  # kg m2; a wheel: m r^2 / 2 of 0.5 kg and 0.08 m
STEER_STIFFNESS, STEER_DAMPING, STEER_FORCE = 220.0, 6.0, 60.0
STEER_STOP_RAD = 2.2  # beyond RobotSettings.steer_limit_rad
WHEEL_STIFFNESS, WHEEL_DAMPING, WHEEL_FORCE = 60.0, 4.0, 3.0
WHEEL_LAG_RAD = 0.4  # a blocked wheel does not wind up further than this
BODY_FRICTION, TYRE_FRICTION = 0.2, 1.0
UPRIGHT = [math.sqrt(0.5), 0.0, -math.sqrt(0.5), 0.0]  # joint axis x -> world z
ACROSS = [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]  # joint axis x -> leg y
ROBOT_GROUP = 2


def flat_pose(x_m: float, y_m: float, yaw_rad: float, z_m: float = 0.0) -> sapien.Pose:
    """Pose from position and heading."""
    return sapien.Pose([x_m, y_m, z_m], [math.cos(yaw_rad / 2), 0.0, 0.0, math.sin(yaw_rad / 2)])


class Robot:
    """The articulation and its low-level controller."""

    def __init__(
        self, scene: sapien.Scene, settings: RobotSettings, x_m: float, y_m: float, yaw_rad: float
    ) -> None:
        """Put the robot on the floor at a pose, at rest, wheels straight."""
        self._settings = settings
        self._articulation = _build(scene, settings, x_m, y_m, yaw_rad)
        joints = {joint.name: joint for joint in self._articulation.active_joints}
        order = [joint.name for joint in self._articulation.active_joints]
        self._steer = [joints[f"steer{k}"] for k in range(4)]
        self._drive = [joints[f"drive{k}"] for k in range(4)]
        self._steer_index = [order.index(f"steer{k}") for k in range(4)]
        self._drive_index = [order.index(f"drive{k}") for k in range(4)]
        self._targets = [LegTarget(0.0, 0.0)] * 4
        self._angles = [0.0] * 4
        self._heading_rad, self._wheel_radps = 0.0, 0.0
        self.links = {link.name: link for link in self._articulation.links}

    def command(self, steer_rad: float, wheel_radps: float) -> None:
        """Roll towards a heading (robot frame) at a wheel speed. A stop keeps the wheels where they point."""
        self._wheel_radps = wheel_radps
        if wheel_radps != 0.0:
            self._heading_rad = steer_rad

    def control(self, dt_s: float) -> None:
        """Set the servo targets for the next physics step."""
        measured = self._articulation.qpos
        for k in range(4):
            steer = float(measured[self._steer_index[k]])
            target = next_target(
                self._heading_rad, self._wheel_radps, steer, self._targets[k], dt_s, self._settings
            )
            self._targets[k] = target
            self._steer[k].set_drive_target(target.steer_rad)
            self._angles[k] = self._next_angle(k, float(measured[self._drive_index[k]]), dt_s)
            self._drive[k].set_drive_target(self._angles[k])
            self._drive[k].set_drive_velocity_target(target.wheel_radps)

    def _next_angle(self, leg: int, measured_rad: float, dt_s: float) -> float:
        """Angle servo: the target turns with the wanted speed, so a stopped wheel does not creep."""
        wanted = self._angles[leg] + self._targets[leg].wheel_radps * dt_s
        return max(measured_rad - WHEEL_LAG_RAD, min(measured_rad + WHEEL_LAG_RAD, wanted))

    def steer_angles_rad(self) -> list[float]:
        """Measured steer angles of the four legs."""
        measured = self._articulation.qpos
        return [float(measured[k]) for k in self._steer_index]

    def pose(self) -> tuple[float, float, float]:
        """True x, y (metres) and yaw (radians)."""
        pose = self._articulation.root_pose
        w, x, y, z = (float(v) for v in pose.q)
        return float(pose.p[0]), float(pose.p[1]), math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def motion(self) -> tuple[float, float, float]:
        """Velocity of the chassis along x and y of the world (m/s), and its turning (rad/s)."""
        x_mps, y_mps = (float(v) for v in self._articulation.root_linear_velocity[:2])
        return x_mps, y_mps, float(self._articulation.root_angular_velocity[2])

    def speed_mps(self) -> float:
        """Speed of the chassis over the floor."""
        return float(np.hypot(*self._articulation.root_linear_velocity[:2]))


def _build(
    scene: sapien.Scene, settings: RobotSettings, x_m: float, y_m: float, yaw_rad: float
) -> physx.PhysxArticulation:
    builder = scene.create_articulation_builder()
    chassis = _add_chassis(builder, settings)
    rubber = physx.PhysxMaterial(TYRE_FRICTION, TYRE_FRICTION, 0.0)
    for k, (x, y) in enumerate(wheel_mounts(settings)):
        _add_leg(builder, chassis, k, sapien.Pose([x, y, settings.wheel_radius_m], UPRIGHT), settings, rubber)
    # The body must not touch its own wheels: group 3 holds an id, group 2 says whom that id ignores.
    for link in builder.link_builders:
        link.collision_groups = [1, 1, ROBOT_GROUP, 7]
    builder.set_initial_pose(flat_pose(x_m, y_m, yaw_rad))
    articulation = builder.build(fix_root_link=False)
    # Until the first step only the root is where it belongs; this puts legs and wheels below it.
    articulation.set_qpos(articulation.get_qpos())
    for joint in articulation.active_joints:
        joint.set_friction(0.0)
        if joint.name.startswith("steer"):
            joint.set_drive_properties(STEER_STIFFNESS, STEER_DAMPING, STEER_FORCE, "force")
        else:
            joint.set_drive_properties(WHEEL_STIFFNESS, WHEEL_DAMPING, WHEEL_FORCE, "force")
    return articulation


def _add_chassis(
    builder: sapien.wrapper.articulation_builder.ArticulationBuilder, settings: RobotSettings
) -> sapien.wrapper.articulation_builder.LinkBuilder:
    """Body and mast, two upright cylinders."""
    slick = physx.PhysxMaterial(BODY_FRICTION, BODY_FRICTION, 0.0)
    chassis = builder.create_link_builder()
    chassis.set_name("chassis")
    for low, high, radius in (
        (settings.body_low_m, settings.body_top_m, settings.body_radius_m),
        (settings.body_top_m, settings.mast_top_m, settings.mast_radius_m),
    ):
        half = (high - low) / 2
        lie = sapien.Pose([0, 0, low + half], UPRIGHT)
        chassis.add_cylinder_collision(lie, radius=radius, half_length=half, material=slick)
    inertia = CHASSIS_KG * settings.body_radius_m**2
    centre = sapien.Pose([0, 0, CHASSIS_CENTRE_M])
    chassis.set_mass_and_inertia(CHASSIS_KG, centre, [inertia / 3, inertia / 3, inertia / 2])
    return chassis


def _add_leg(
    builder: sapien.wrapper.articulation_builder.ArticulationBuilder,
    chassis: sapien.wrapper.articulation_builder.LinkBuilder,
    number: int,
    mount: sapien.Pose,
    settings: RobotSettings,
    rubber: physx.PhysxMaterial,
) -> None:
    """A leg that steers below the chassis, and its wheel."""
    leg = builder.create_link_builder(chassis)
    leg.set_name(f"leg{number}")
    leg.set_joint_name(f"steer{number}")
    limits = [[-STEER_STOP_RAD, STEER_STOP_RAD]]
    leg.set_joint_properties("revolute", limits, mount, sapien.Pose([0, 0, 0], UPRIGHT))
    leg.set_mass_and_inertia(LEG_KG, sapien.Pose(), [LEG_INERTIA] * 3)
    wheel = builder.create_link_builder(leg)
    wheel.set_name(f"wheel{number}")
    wheel.set_joint_name(f"drive{number}")
    axle = sapien.Pose([0, 0, 0], ACROSS)
    wheel.set_joint_properties("revolute_unwrapped", [[-np.inf, np.inf]], axle, axle)
    wheel.add_sphere_collision(radius=settings.wheel_radius_m, material=rubber)
    wheel.set_mass_and_inertia(WHEEL_KG, sapien.Pose(), [WHEEL_INERTIA] * 3)
