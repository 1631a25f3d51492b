"""A person in the plane world who drives the robot by hand along true points, while a mission goes along."""

import math
from collections.abc import Iterable
from itertools import pairwise

from services.drive.core import Memory, Since, compute_velocity
from services.drive.limits import DriveLimits
from services.planner.ports import Decision, Mission
from shared.messages.drive import Heading
from shared.motion.motion import NO_MOTION
from tests.plane_world import STEP_S, PlaneWorld, Pose

NEAR_M = 0.15
TURN_RAD = 0.3
"""In a frame: people turn with the way they go."""
PATIENCE = 200


def lead(
    world: PlaneWorld,
    mission: Mission,
    stops: Iterable[tuple[float, float]],
    share: float = 0.5,
) -> list[tuple[Pose, Decision]]:
    """Drive from stop to stop on the shortest free way; poses with what the mission said there.

    Args:
        world: with the robot at the first stop or anywhere else.
        mission: goes along.
        stops: true points.
        share: of the full speed.
    """
    memory = Memory()
    points = [world.pose[:2], *stops]
    way = [point for a, b in pairwise(points) for point in world.space.shortest_path(a, b)[1:]]
    observation = world.observe()
    said = [(world.pose, mission.decide(observation))]
    for point in way:
        for _ in range(PATIENCE):
            x, y, yaw = world.pose
            away_m = math.dist((x, y), point)
            if away_m < NEAR_M:
                break
            off_rad = math.remainder(math.atan2(point[1] - y, point[0] - x) - yaw, math.tau)
            heading = Heading(
                robot="r1", seq=world.seq, action="go", heading_rad=off_rad, s_slow=150, s_max=300,
                speed_fraction=share, distance_m=away_m,
            )  # fmt: skip
            velocity, memory = compute_velocity(
                heading, observation.ranges, Since(step=world.moved), memory, world.rng, DriveLimits()
            )
            turn_radps = max(-TURN_RAD, min(TURN_RAD, off_rad)) / STEP_S
            world.move(velocity.forward_mps, velocity.left_mps, turn_radps)
            observation = world.observe()
            said.append((world.pose, mission.decide(observation)))
        else:
            raise AssertionError(f"the person does not get to {point}, stands at {world.pose}")
    world.moved = NO_MOTION
    return said
