"""The robot's body and wheels as a PhysX articulation, built from its undercarriage."""

import math

import numpy as np
import sapien
from sapien import physx

from simulator.robot.undercarriage import Mount, undercarriage_of
from simulator.settings import RobotSettings

# Masses, servos and friction are chosen for a robot of 18 kg that follows its commands: it rolls at 0.4 m/s
# (5 rad/s on wheels of 0.08 m), stands within a step or two, and does not push furniture or walkers.
CHASSIS_KG, LEG_KG, WHEEL_KG = 14.0, 0.5, 0.5
CHASSIS_CENTRE_M = 0.08  # low, so that it does not tip
LEG_INERTIA, WHEEL_INERTIA = 0.002, 0.0016  # kg m2; a wheel: m r^2 / 2 of 0.5 kg and 0.08 m
STEER_STIFFNESS, STEER_DAMPING, STEER_FORCE = 220.0, 6.0, 60.0
STEER_STOP_RAD = 0.3  # beyond the servo's own limit
WHEEL_STIFFNESS, WHEEL_DAMPING, WHEEL_FORCE = 60.0, 4.0, 3.0
WHEEL_LAG_RAD = 0.4  # a blocked wheel does not wind up further than this
BODY_FRICTION, TYRE_FRICTION = 0.2, 1.0
BALL_RADIUS_M, BALL_GAP_M = 0.02, 0.0005  # a ball carries only when the robot nods: by 0.2 degrees at most
UPRIGHT = [math.sqrt(0.5), 0.0, -math.sqrt(0.5), 0.0]  # joint axis x -> world z
ACROSS = [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]  # joint axis x -> leg y
ROBOT_GROUP = 2


def flat_pose(x_m: float, y_m: float, yaw_rad: float, z_m: float = 0.0) -> sapien.Pose:
    """Pose from position and heading."""
    return sapien.Pose([x_m, y_m, z_m], [math.cos(yaw_rad / 2), 0.0, 0.0, math.sin(yaw_rad / 2)])


def build(
    scene: sapien.Scene, settings: RobotSettings, x_m: float, y_m: float, yaw_rad: float
) -> physx.PhysxArticulation:
    """Put a robot on the floor: links chassis, legK and wheelK, joints steerK and driveK, by mount."""
    builder = scene.create_articulation_builder()
    chassis = _add_chassis(builder, settings)
    rubber = physx.PhysxMaterial(TYRE_FRICTION, TYRE_FRICTION, 0.0)
    mounts = undercarriage_of(settings.base).mounts
    for k, mount in enumerate(mounts):
        if mount.steered:
            leg = _add_leg(builder, chassis, k, mount)
            _add_wheel(builder, leg, k, mount, sapien.Pose([0, 0, 0], ACROSS), rubber)
        else:
            axle = sapien.Pose([mount.x_m, mount.y_m, mount.radius_m], ACROSS)
            _add_wheel(builder, chassis, k, mount, axle, rubber)
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
        elif mounts[int(joint.name.removeprefix("drive"))].driven:
            joint.set_drive_properties(WHEEL_STIFFNESS, WHEEL_DAMPING, WHEEL_FORCE, "force")
    return articulation


def _add_chassis(
    builder: sapien.wrapper.articulation_builder.ArticulationBuilder, settings: RobotSettings
) -> sapien.wrapper.articulation_builder.LinkBuilder:
    """Body and mast, two upright cylinders, and the balls it slides on."""
    slick = physx.PhysxMaterial(BODY_FRICTION, BODY_FRICTION, 0.0)
    undercarriage = undercarriage_of(settings.base)
    chassis = builder.create_link_builder()
    chassis.set_name("chassis")
    for low, high, radius in (
        (settings.body_low_m, settings.body_top_m, settings.body_radius_m),
        (settings.body_top_m, settings.mast_top_m, settings.mast_radius_m),
    ):
        half = (high - low) / 2
        lie = sapien.Pose([0, 0, low + half], UPRIGHT)
        chassis.add_cylinder_collision(lie, radius=radius, half_length=half, material=slick)
    smooth = physx.PhysxMaterial(0.0, 0.0, 0.0)
    for x_m, y_m in undercarriage.balls_m:
        place = sapien.Pose([x_m, y_m, BALL_RADIUS_M + BALL_GAP_M])
        chassis.add_sphere_collision(place, radius=BALL_RADIUS_M, material=smooth)
    inertia = CHASSIS_KG * settings.body_radius_m**2
    centre = sapien.Pose([undercarriage.weight_x_m, 0, CHASSIS_CENTRE_M])
    chassis.set_mass_and_inertia(CHASSIS_KG, centre, [inertia / 3, inertia / 3, inertia / 2])
    return chassis


def _add_leg(
    builder: sapien.wrapper.articulation_builder.ArticulationBuilder,
    chassis: sapien.wrapper.articulation_builder.LinkBuilder,
    number: int,
    mount: Mount,
) -> sapien.wrapper.articulation_builder.LinkBuilder:
    """A leg that steers below the chassis."""
    leg = builder.create_link_builder(chassis)
    leg.set_name(f"leg{number}")
    leg.set_joint_name(f"steer{number}")
    stop_rad = mount.limit_rad + STEER_STOP_RAD
    place = sapien.Pose([mount.x_m, mount.y_m, mount.radius_m], UPRIGHT)
    leg.set_joint_properties("revolute", [[-stop_rad, stop_rad]], place, sapien.Pose([0, 0, 0], UPRIGHT))
    leg.set_mass_and_inertia(LEG_KG, sapien.Pose(), [LEG_INERTIA] * 3)
    return leg


def _add_wheel(
    builder: sapien.wrapper.articulation_builder.ArticulationBuilder,
    parent: sapien.wrapper.articulation_builder.LinkBuilder,
    number: int,
    mount: Mount,
    place: sapien.Pose,
    rubber: physx.PhysxMaterial,
) -> None:
    """A wheel on a leg, or on the chassis."""
    wheel = builder.create_link_builder(parent)
    wheel.set_name(f"wheel{number}")
    wheel.set_joint_name(f"drive{number}")
    axle = sapien.Pose([0, 0, 0], ACROSS)
    wheel.set_joint_properties("revolute_unwrapped", [[-np.inf, np.inf]], place, axle)
    wheel.add_sphere_collision(radius=mount.radius_m, material=rubber)
    wheel.set_mass_and_inertia(WHEEL_KG, sapien.Pose(), [WHEEL_INERTIA] * 3)
