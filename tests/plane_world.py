"""A flat stand-in for pictures: the true floor plan, where similarity and headings follow distance.

Missions and the drive core run here thousands of steps a second. The figures of similarity and disparity
against distance are those measured on rendered frames; headings carry noise and rare outliers.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Protocol

import numpy as np

from services.drive.core import Memory, Since, compute_velocity
from services.drive.limits import DriveLimits
from services.planner.ports import Decision, Mission, Observation, RightOfWay
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.keep_clear import current_limits
from shared.mapgraph.rules import Limits
from shared.messages.drive import Heading
from shared.messages.features import Features
from shared.messages.maps import AddNode, Operation
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, Motion, driven
from shared.wall_clock import WallClock
from simulator.scene.parts import Material, Part
from simulator.scene.shapes import post
from simulator.world.footprints import Footprints, cast_rays, clearance_m, footprints
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

DISTANCES_M = (0.0, 0.35, 0.75, 1.25, 1.75, 2.25, 3.0, 5.0)
INLIERS = (260, 109, 81, 54, 43, 33, 22, 12)
DISPARITY_DEG = (0.1, 4.5, 8.1, 12.4, 15.0, 18.3, 22.0, 30.0)
BEAM_RAYS = np.deg2rad(np.linspace(-15.0, 15.0, 7))
KEYPOINTS = 300
MAX_RANGE_M = 4.0
STEP_S = 0.3
BODY_RADIUS_M = 0.25
NOON = WallClock(29_923_920)
Pose = tuple[float, float, float]


class Moving(Protocol):
    """Who is where no wall is, now."""

    def walk(self, robot: Pose) -> None:
        """Time goes on by a step."""

    def touches(self, point: tuple[float, float]) -> bool:
        """Whether a robot there bumps into it."""

    def part(self) -> Part:
        """It as a solid."""


@dataclass
class Walker:
    """A person who walks to and fro, stops in front of the robot, and turns back if it does not give way."""

    ends: tuple[tuple[float, float], tuple[float, float]]
    speed_mps: float = 0.5
    radius_m: float = 0.22
    polite_m: float = 0.75
    patience_steps: int = 30
    waited_steps: int = 0
    share: float = 0.0
    direction: int = 1

    @property
    def point(self) -> tuple[float, float]:
        """Where the person is."""
        (x, y), (u, v) = self.ends
        return x + self.share * (u - x), y + self.share * (v - y)

    def walk(self, robot: Pose) -> None:
        """One step, unless the robot would be too near; after some steps of waiting, the other way."""
        before = self.share
        self.share += self.direction * self.speed_mps * STEP_S / math.dist(*self.ends)
        if not 0.0 <= self.share <= 1.0:
            self.direction, self.share = -self.direction, min(1.0, max(0.0, self.share))
        if math.dist(self.point, robot[:2]) >= self.polite_m:
            self.waited_steps = 0
            return
        self.share = before
        self.waited_steps += 1
        if self.waited_steps % self.patience_steps == 0:
            self.direction = -self.direction

    def touches(self, point: tuple[float, float]) -> bool:
        """Whether a robot there bumps into the person."""
        return math.dist(self.point, point) < self.radius_m + BODY_RADIUS_M

    def part(self) -> Part:
        """The person as a solid."""
        return post(*self.point, (0.0, 1.7), self.radius_m, Material("lacquer"))


@cache
def apartment() -> FreeSpace:
    """The floor of the apartment, which nothing changes in place."""
    return free_space(load_world("apartment"))


@dataclass
class PlaneWorld:
    """The robot's true pose and everything that can be sensed from it."""

    pose: Pose
    rng: np.random.Generator
    space: FreeSpace = field(default_factory=apartment)
    seq: int = 0
    collisions: int = 0
    driven_m: float = 0.0
    moved: Motion = NO_MOTION
    walkers: list["Moving"] = field(default_factory=list)
    max_range_m: float = MAX_RANGE_M

    def __post_init__(self) -> None:
        self.shapes = footprints(self.space.parts, 0.02, 0.79)
        self.opaque = footprints(self.space.parts, 0.79, 0.81)
        self.high = footprints(self.space.parts, 1.79, 1.81)

    def put(self, part: Part) -> None:
        """Put an obstacle into the world, such as a door that closes."""
        band = footprints((part,), 0.02, 0.79)
        rows, columns = np.indices(self.space.free.shape).reshape(2, -1)
        points = np.stack([columns, rows], axis=-1) * self.space.resolution_m + np.array(self.space.origin_m)
        apart_m = clearance_m(points, band).reshape(self.space.free.shape)
        free = self.space.free & (apart_m >= self.space.robot_radius_m)
        self._use(replace(self.space, free=free, parts=(*self.space.parts, part)))

    def take_away(self, before: FreeSpace) -> None:
        """Go back to an earlier state of the world."""
        self._use(before)

    def _use(self, space: FreeSpace) -> None:
        self.space = space
        self.__post_init__()

    def view(self, here: Pose, there: Pose) -> float:
        """Share of the view that two poses have in common: furniture hides much of it, a wall nearly all."""
        if not _open(here, there, self.high):
            return 0.1
        return 1.0 if _open(here, there, self.opaque) else 0.3

    def observe(self) -> Observation:
        """Features that carry the true pose for `PlaneMatcher` only, and 12 distances."""
        angles = np.arange(12) * math.tau / 12
        rays = (self.pose[2] + angles[:, None] + BEAM_RAYS).ravel()
        here = np.array(self.pose[:2])
        hits = cast_rays(here, rays, self.shapes, self.max_range_m)
        if self.walkers:
            moving = footprints(tuple(walker.part() for walker in self.walkers), 0.02, 0.79)
            hits = np.minimum(hits, cast_rays(here, rays, moving, self.max_range_m))
        hits = hits.reshape(12, -1).min(axis=1)
        noisy = np.clip(hits + self.rng.normal(0.0, 0.01, 12), 0.0, self.max_range_m)
        ranges = Ranges(
            seq=self.seq,
            robot="r1",
            angles_rad=tuple(angles),
            distances_m=tuple(np.where(hits < self.max_range_m, noisy, self.max_range_m)),
            max_range_m=self.max_range_m,
        )
        return Observation(picture(self.pose, self.seq), ranges, self.moved)

    def move(self, forward_mps: float, left_mps: float, turn_radps: float) -> None:
        """Drive one control step; an obstacle stops the robot and counts as a collision."""
        self.moved = driven(forward_mps, left_mps, turn_radps, STEP_S)
        part = driven(forward_mps, left_mps, turn_radps, STEP_S / 4)
        for _ in range(4):
            there = Motion(*self.pose).then(part)
            x, y = there.x_m, there.y_m
            if not self.space.is_free((x, y)) or any(walker.touches((x, y)) for walker in self.walkers):
                self.collisions += 1
                break
            self.pose = (x, y, there.turn_rad)
            self.driven_m += part.way_m
        for walker in self.walkers:
            walker.walk(self.pose)
        self.seq += 1


def _open(here: Pose, there: Pose, shapes: Footprints) -> bool:
    """Whether no outline stands between two poses."""
    distance_m = math.dist(here[:2], there[:2])
    bearing = math.atan2(there[1] - here[1], there[0] - here[0])
    free_m = cast_rays(np.array(here[:2]), np.array([bearing]), shapes, distance_m)
    return bool(free_m[0] >= distance_m - 1e-6)


ALIKE = 0.8
"""Share of its matches that a look-alike of a spot has: what is far away differs."""


def picture(pose: Pose, seq: int = 0) -> Features:
    """What a camera at `pose` sees: here, the pose itself."""
    return Features(
        seq=seq,
        stamp_ns=seq,
        pipeline="plane",
        lonlat_rad=np.zeros((KEYPOINTS, 2), np.float32),
        scores=np.zeros(KEYPOINTS, np.float32),
        descriptors=np.tile(np.array([pose], np.float32), (KEYPOINTS, 1)),
    )


@dataclass
class PlaneMap:
    """The map in memory, with the true pose of each node kept aside."""

    graph: MapGraph = field(default_factory=MapGraph)
    poses: dict[int, Pose] = field(default_factory=dict)
    shared: bool = False

    def limits(self) -> Limits:
        """What the rules say on a Monday at noon."""
        return current_limits(self.graph, NOON)

    def commit(self, operations: Sequence[Operation]) -> None:
        """Apply, and remember where new nodes were seen from."""
        self.graph.apply(operations)
        for operation in operations:
            if isinstance(operation, AddNode):
                self.poses[operation.node.node_id] = _pose_of(operation.features)

    def right_of_way(self, _at: Sequence[int], ahead: Sequence[int]) -> RightOfWay:
        """Nobody else drives here."""
        return RightOfWay(len(ahead))


class PlaneMatcher:
    """Matches by true distance and line of sight; `blind` sees nothing that resembles anything.

    With a `period_m` all looks alike again so far along x: nodes are seen where the nearest image of them is.
    Views carry `carries` times as far as in a furnished flat.
    """

    def __init__(
        self, world: PlaneWorld, maps: PlaneMap, period_m: float = math.inf, carries: float = 1.0
    ) -> None:
        self._world, self._maps, self._period_m, self._carries = world, maps, period_m, carries
        self.blind = False

    def match(
        self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()
    ) -> dict[int, NodeMatch]:
        """As the feature service answers for the current frame."""
        found = self._compare(self._world.pose, node_ids, best_k)
        for number, target in enumerate(targets, start=1):
            found[-number] = self._pair(-number, self._world.pose, _pose_of(target))
        return found

    def locate(
        self,
        features: Features,
        best_k: int,
        node_ids: Sequence[int] = (),
        *,
        with_differences: bool = False,  # noqa: ARG002 - there are no pictures
    ) -> dict[int, NodeMatch]:
        """As the feature service answers for a goal picture."""
        return self._compare(_pose_of(features), node_ids, best_k)

    def _compare(self, pose: Pose, node_ids: Sequence[int], best_k: int) -> dict[int, NodeMatch]:
        poses = self._maps.poses
        near = sorted(poses, key=lambda n: math.dist(pose[:2], self._image(pose, poses[n])[:2]))[:best_k]
        pairs = [self._pair(n, pose, poses[n]) for n in dict.fromkeys([*node_ids, *near])]
        return {match.node_id: match for match in sorted(pairs, key=lambda m: -m.inliers)}

    def _image(self, here: Pose, there: Pose) -> Pose:
        """The nearest of the spots that look like `there`."""
        periods = round((here[0] - there[0]) / self._period_m)
        return (there[0] + (periods * self._period_m if periods else 0.0), there[1], there[2])

    def _pair(self, node_id: int, here: Pose, there: Pose) -> NodeMatch:
        there, true = self._image(here, there), there
        alike = 1.0 if there == true else ALIKE
        distance_m = math.dist(here[:2], there[:2])
        rng = self._world.rng
        seen = 0.0 if self.blind else alike * self._world.view(here, there)
        as_far_m = distance_m / self._carries
        inliers = int(np.interp(as_far_m, DISTANCES_M, INLIERS) * seen * rng.uniform(0.85, 1.15))
        disparity_deg = float(np.interp(as_far_m, DISTANCES_M, DISPARITY_DEG))
        heading = math.atan2(there[1] - here[1], there[0] - here[0]) - here[2]
        wild = rng.uniform() < 0.02 * (1.0 if inliers > 30 else 5.0)
        noise = rng.uniform(-math.pi, math.pi) if wild else rng.normal(0.0, math.radians(0.5))
        status = "too_few" if inliers < 12 else "no_baseline" if disparity_deg < 0.3 else "ok"
        return NodeMatch(
            node_id=node_id,
            raw_matches=int(inliers * 1.4) + 8,
            inliers=inliers,
            status=status,
            heading_rad=math.remainder(heading + noise, math.tau) if status == "ok" else None,
            heading_std_rad=math.radians(0.5),
            yaw_rad=math.remainder(there[2] - here[2], math.tau),
            disparity_rad=math.radians(disparity_deg),
            confidence=0.9,
        )


def run(
    world: PlaneWorld,
    mission: Mission,
    limits: DriveLimits,
    max_steps: int,
    path: list[Pose] | None = None,
    restart_steps: int = 0,
) -> tuple[Decision, int]:
    """Observe, decide, drive until the mission ends; the last decision and the number of steps.

    Every `restart_steps` the drive service starts anew, if that is not 0.
    """
    memory = Memory()
    for step in range(max_steps):
        if restart_steps and step % restart_steps == 0:
            memory = Memory()
        observation = world.observe()
        decision = mission.decide(observation)
        if decision.outcome:
            return decision, step
        memory = follow(world, decision, observation, memory, limits)
        if path is not None:
            path.append(world.pose)
    return decision, max_steps


def follow(
    world: PlaneWorld, decision: Decision, observation: Observation, memory: Memory, limits: DriveLimits
) -> Memory:
    """Drive for one frame as was decided for it; what the drive service remembers of it."""
    heading = Heading(
        robot="r1",
        seq=world.seq,
        action=decision.action,
        heading_rad=decision.heading_rad,
        face_rad=decision.face_rad,
        s_cv=decision.s_cv,
        s_slow=150,
        s_max=300,
        speed_fraction=DEFAULT.travel.room_speed * decision.speed_fraction,
        distance_m=decision.distance_m,
        why=decision.why,
    )
    since = Since(step=world.moved)
    velocity, memory = compute_velocity(heading, observation.ranges, since, memory, world.rng, limits)
    world.move(velocity.forward_mps, velocity.left_mps, velocity.turn_radps)
    return memory


def _pose_of(features: Features) -> Pose:
    x, y, yaw = (float(v) for v in features.descriptors[0])
    return x, y, yaw
