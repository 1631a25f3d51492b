"""The physical world: floor, the solid parts as static bodies, the robot, and a count of collisions.

It is apart from the rendered world and cheap to build, so a reset builds it anew: no contact or solver state
survives, which makes equal seeds and commands give bit-equal poses.
"""

import math
from dataclasses import dataclass

import numpy as np
import sapien
from sapien import physx

from simulator.robot.articulation import UPRIGHT, flat_pose
from simulator.robot.robot import Robot
from simulator.scene.parts import Part, Pose2, solids_between
from simulator.settings import RobotSettings
from simulator.world.footprints import hull_corners_m

TOUCH_N_S = 1e-6  # an impulse above rounding
EPISODE_GAP_S = 0.5  # touches further apart than this are two collisions; chosen
THRESHOLD_M = 0.02  # freespace.BODY_BAND_M: lower hulls are neither felt by the sensors nor hit by the robot
ABOVE_M = 0.05  # what begins this far above the mast cannot be hit; chosen
FRICTION, WALKER_FRICTION = 0.9, 0.2  # rubber on floors; smooth sides, along which the robot slides; chosen


@dataclass(frozen=True)
class Bodies:
    """Poses of the robot's links by name, of the hider if there is one, and of what else moves.

    Attributes:
        walkers: people, then other robots; None for one that is not there.
    """

    links: dict[str, sapien.Pose]
    hider: Pose2 | None
    walkers: list[Pose2 | None]


class PhysicsScene:
    """One robot among static bodies."""

    def __init__(
        self, parts: tuple[Part, ...], settings: RobotSettings, timestep_s: float, pose: Pose2
    ) -> None:
        """Build everything with the robot at a pose, at rest."""
        config = physx.PhysxSceneConfig()
        config.enable_enhanced_determinism = True
        physx.set_scene_config(config)
        self._timestep_s = timestep_s
        self._scene = sapien.Scene([physx.PhysxCpuSystem()])
        self._scene.set_timestep(timestep_s)
        self._system = self._scene.physx_system
        self._floor = _add_static(self._scene, parts, settings.mast_top_m)
        self.robot = Robot(self._scene, settings, *pose)
        self._own = {link.entity.per_scene_id for link in self.robot.links.values()}
        self._last_touch_s = -math.inf
        self.time_s, self.collisions = 0.0, 0

    def add_walker(self, solid: Part) -> physx.PhysxRigidDynamicComponent:
        """Add a box or an upright cylinder that goes where it is put and pushes; see `move_walker`."""
        builder = self._scene.create_actor_builder()
        _add_solid(builder, solid, physx.PhysxMaterial(WALKER_FRICTION, WALKER_FRICTION, 0.0))
        entity = builder.build_kinematic(name="walker")
        return entity.find_component_by_type(physx.PhysxRigidDynamicComponent)

    def move_walker(
        self, walker: physx.PhysxRigidDynamicComponent, pose: Pose2, at_once: bool = False
    ) -> None:
        """Where a walker is after the next step, or, `at_once`, now."""
        target = flat_pose(*pose)
        if at_once:
            walker.entity.set_pose(target)
        walker.set_kinematic_target(target)

    def step(self) -> None:
        """Advance by one timestep."""
        self.robot.control(self._timestep_s)
        self._scene.step()
        self.robot.measure(self._timestep_s)
        self.time_s += self._timestep_s
        if self._touching():
            if self.time_s - self._last_touch_s > EPISODE_GAP_S:
                self.collisions += 1
            self._last_touch_s = self.time_s

    def _touching(self) -> bool:
        """Whether the robot presses against anything but the floor."""
        for contact in self._system.get_contacts():
            ids = [body.entity.per_scene_id for body in contact.bodies]
            if self._floor in ids or not any(k in self._own for k in ids):
                continue
            if any(
                float(np.abs(point.impulse).sum()) > TOUCH_N_S or point.separation < 0.0
                for point in contact.points
            ):
                return True
        return False


def _add_static(scene: sapien.Scene, parts: tuple[Part, ...], height_m: float) -> int:
    """Add floor and solids that the robot can reach; returns the floor's id."""
    material = physx.PhysxMaterial(FRICTION, FRICTION, 0.0)
    floor = scene.create_actor_builder()
    floor.add_box_collision(sapien.Pose([0, 0, -0.5]), half_size=[100, 100, 0.5], material=material)
    entity = floor.build_static(name="floor")
    solids = scene.create_actor_builder()
    for part in solids_between(parts, 0.0, height_m + ABOVE_M):
        if part.shape != "hull":
            _add_solid(solids, part, material)
    solids.build_static(name="solids")
    _add_hulls(scene, solids_between(parts, THRESHOLD_M, height_m + ABOVE_M), material)
    return int(entity.per_scene_id)


def _add_solid(builder: sapien.ActorBuilder, part: Part, material: physx.PhysxMaterial) -> None:
    """Add one part to a body: a cylinder, or a box for every other shape."""
    x, y, z = part.centre_m
    turn = flat_pose(x, y, part.yaw_rad, z)
    if part.shape == "cylinder":
        radius = part.size_m[0] / 2 * max(1.0, part.taper)
        builder.add_cylinder_collision(
            turn * sapien.Pose([0, 0, 0], UPRIGHT),
            radius=radius,
            half_length=part.size_m[2] / 2,
            material=material,
        )
    else:
        builder.add_box_collision(turn, half_size=[s / 2 for s in part.size_m], material=material)


def _add_hulls(scene: sapien.Scene, parts: list[Part], material: physx.PhysxMaterial) -> None:
    """Add upright prisms: the very outlines that the distance sensors measure."""
    hulls = [part for part in parts if part.shape == "hull"]
    if not hulls:
        return
    body = physx.PhysxRigidStaticComponent()
    for part in hulls:
        outline = hull_corners_m(part) - np.array(part.centre_m[:2])
        half = part.size_m[2] / 2
        corners = np.array([(x, y, z) for z in (-half, half) for x, y in outline], np.float32)
        shape = physx.PhysxCollisionShapeConvexMesh(corners, np.ones(3, np.float32), material)
        shape.set_local_pose(sapien.Pose(list(part.centre_m)))
        body.attach(shape)
    entity = sapien.Entity()
    entity.add_component(body)
    scene.add_entity(entity)
