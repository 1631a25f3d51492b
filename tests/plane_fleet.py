"""Several robots at once on a true floor plan, each with its planner and drive, and the rights of way."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from services.drive.core import Memory
from services.drive.limits import DriveLimits
from services.fleet import choice
from services.fleet.choice import choose
from services.fleet.condition import READY
from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.rights import Claim, Rights
from services.planner.missions.goto import Goto
from services.planner.ports import RightOfWay
from services.planner.profiles import DEFAULT
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import metres_to
from shared.messages.tasks import Task
from shared.transport.keys import ANY
from simulator.scene.parts import Material, Part
from simulator.scene.shapes import post
from simulator.world.freespace import FreeSpace
from tests.plane_world import BODY_RADIUS_M, STEP_S, PlaneMap, PlaneMatcher, PlaneWorld, Pose, follow, picture

MAP = "flat"


@dataclass
class Desk:
    """Grants rights of way in one map; without `rights` everybody may go everywhere."""

    maps: PlaneMap
    rights: Rights | None = field(default_factory=Rights)
    now_s: float = 0.0

    def __post_init__(self) -> None:
        self.near = Nearness(self.maps.graph)

    def ask(self, name: str, at: Sequence[int], ahead: Sequence[int], *, busy: bool = True) -> RightOfWay:
        """What a robot is told."""
        if self.rights is None:
            return RightOfWay(len(ahead))
        grant = self.rights.ask(Claim(name, MAP, tuple(at), tuple(ahead), busy=busy), self.near, self.now_s)
        return RightOfWay(grant.free, grant.why, grant.room)


class SharedMap(PlaneMap):
    """The map as one of several robots knows it."""

    def __init__(self, maps: PlaneMap, name: str, desk: Desk) -> None:
        super().__init__(maps.graph, maps.poses, shared=True)
        self._name, self._desk = name, desk

    def right_of_way(self, at: Sequence[int], ahead: Sequence[int]) -> RightOfWay:
        return self._desk.ask(self._name, at, ahead)


@dataclass
class Other:
    """Another robot, as one sees and hits it."""

    world: PlaneWorld

    def walk(self, robot: Pose) -> None:
        """It goes by itself."""

    def touches(self, point: tuple[float, float]) -> bool:
        """Whether two bodies overlap."""
        return math.dist(self.world.pose[:2], point) < 2.0 * BODY_RADIUS_M

    def part(self) -> Part:
        """As a solid."""
        return post(*self.world.pose[:2], (0.0, 0.8), BODY_RADIUS_M, Material("lacquer"))


class Robot:
    """One of them."""

    def __init__(self, name: str, node: int, desk: Desk, space: FreeSpace, rng: np.random.Generator) -> None:
        x, y, _ = desk.maps.poses[node]
        self.name, self._desk = name, desk
        self.world = PlaneWorld((x, y, float(rng.uniform(-math.pi, math.pi))), rng, space)
        self._maps = SharedMap(desk.maps, name, desk)
        self._matcher = PlaneMatcher(self.world, self._maps)
        yaw_rad = self.world.pose[2] - desk.maps.poses[node][2]
        self.whereabouts = Whereabouts(MAP, Displacement(node, yaw_rad=yaw_rad))
        self._mission: Goto | None = None
        self._memory = Memory()
        self.has_task = False
        self.waited = 0
        self.ends: list[str] = []

    @property
    def node(self) -> int | None:
        """At which it believes to be."""
        return None if self.whereabouts.here is None else self.whereabouts.here.node_id

    @property
    def idle(self) -> bool:
        """Whether it is on no mission."""
        return self._mission is None

    def begin(self, node: int, *, task: bool) -> None:
        """Drive to a node, as a task or only out of the way."""
        goal = picture(self._desk.maps.poses[node])
        self.has_task = task
        self._mission = Goto(DEFAULT, self._maps, self._matcher, goal, self.whereabouts)

    def step(self, limits: DriveLimits) -> None:
        """One frame."""
        if self._mission is None:
            self._desk.ask(self.name, () if self.node is None else (self.node,), (), busy=False)
            return
        observation = self.world.observe()
        decision = self._mission.decide(observation)
        if decision.outcome:
            self.ends += [decision.failure or decision.outcome] if self.has_task else []
            self._mission, self.has_task = None, False
            return
        self.waited += decision.why.startswith("waits") or "others go first" in decision.why
        self._memory = follow(self.world, decision, observation, self._memory, limits)


@dataclass
class Outcome:
    """How a fleet did.

    Attributes:
        steps: frames until all was done, or nobody may take longer.
        ends: how the tasks ended.
        left: tasks that did not.
        nearest_m: how near the middles of two robots came; None of one alone.
        waited: frames in which a robot waited for others, of all robots.
        sent: times one was sent out of the way.
    """

    steps: int
    ends: list[str]
    left: int
    collisions: int
    driven_m: float
    nearest_m: float | None
    waited: int
    sent: int


class Fleet:
    """Robots that begin at some nodes share tasks, which the fleet's service hands out."""

    def __init__(self, desk: Desk, space: FreeSpace, starts: Sequence[int], seed: int) -> None:
        generators = [np.random.default_rng([seed, number]) for number in range(len(starts))]
        self._desk, self.sent = desk, 0
        self.robots = [
            Robot(f"r{number + 1}", node, desk, space, generators[number])
            for number, node in enumerate(starts)
        ]
        for robot in self.robots:
            robot.world.walkers = [Other(other.world) for other in self.robots if other is not robot]

    def play(self, goals: Sequence[int], max_steps: int) -> Outcome:
        """Drive to all goals."""
        waiting = [
            Task(task_id=f"t{number}", robot=ANY, kind="goto", map=MAP, parameters={"goal_node": goal})
            for number, goal in enumerate(goals)
        ]
        by_name, overtaken = {robot.name: robot for robot in self.robots}, Counter[str]()
        limits, step, nearest_m = DriveLimits(), 0, math.inf
        while step < max_steps and (waiting or any(robot.has_task for robot in self.robots)):
            self._desk.now_s = step * STEP_S
            self._send_away()
            for move in choose(waiting, *self._idle_and_all(), (), self._way_m, overtaken):
                waiting.remove(move.task)
                overtaken.update(move.overtaken)
                by_name[move.to].begin(_goal(move.task), task=True)
            for robot in self.robots:
                robot.step(limits)
            spots = [robot.world.pose[:2] for robot in self.robots]
            nearest_m = min([nearest_m, *(math.dist(a, b) for a, b in combinations(spots, 2))])
            step += 1
        return Outcome(
            steps=step,
            ends=[end for robot in self.robots for end in robot.ends],
            left=len(waiting) + sum(robot.has_task for robot in self.robots),
            collisions=sum(robot.world.collisions for robot in self.robots),
            driven_m=sum(robot.world.driven_m for robot in self.robots),
            nearest_m=nearest_m if len(self.robots) > 1 else None,
            waited=sum(robot.waited for robot in self.robots),
            sent=self.sent,
        )

    def _idle_and_all(self) -> tuple[list[choice.Robot], list[choice.Robot]]:
        robots = [choice.Robot(robot.name, READY, map=MAP, node=robot.node) for robot in self.robots]
        return [told for told, robot in zip(robots, self.robots, strict=True) if robot.idle], robots

    def _way_m(self, task: Task, robot: choice.Robot) -> float:
        return metres_to(self._desk.maps.graph, _goal(task)).get(robot.node or 0, math.inf)

    def _send_away(self) -> None:
        """As the fleet service does with those that have nothing to do and stand in the way."""
        if self._desk.rights is None:
            return
        for claim in self._desk.rights.standing(self._desk.now_s):
            robot = next(robot for robot in self.robots if robot.name == claim.robot)
            if robot.idle:
                robot.begin(claim.room[-1], task=False)
                self.sent += 1


def _goal(task: Task) -> int:
    goal = task.parameters["goal_node"]
    assert isinstance(goal, int)
    return goal
