"""Trials of recovery: a robot that is carried away, a goal that is elsewhere, a door that was shut."""

import math
from typing import Any

import numpy as np

from experiments.rendered.frames import camera
from services.launcher.client.failure import ExperimentError
from services.launcher.client.mission import MissionRun, goal_features
from services.launcher.client.stack import Stack
from services.launcher.client.trail import collisions
from services.launcher.evaluation.outcome import Round
from services.launcher.evaluation.rounds import MARGIN_M, Game
from services.launcher.terminal.output import rounded
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

TRIES = 10
"""Rounds in a row that may end before the robot is carried away."""

CARRIED_AT_STEPS = (5, 40)
"""Once it is on its way, and before most rounds end."""

MAX_STEPS = 1500
"""The usual bound of a round, as of `topnav hide-and-seek`."""

DOOR, DOOR_NAME, DOOR_APART_M = "bookshelf", "shut door", 0.5
"""What shuts a door, and how far from it robot and hider stand: neither is under the shelf."""

Row = dict[str, Any]


def carried(game: Game, space: FreeSpace, seed: int, rng: np.random.Generator) -> Row:
    """A round in which the robot is put elsewhere after a few steps; a shorter round is played again."""
    for _ in range(TRIES):
        row = _carried_once(game, space, seed, rng)
        if row is not None:
            return row
    raise ExperimentError(f"{TRIES} rounds ended before the robot could be carried: choose another --seed")


def _carried_once(game: Game, space: FreeSpace, seed: int, rng: np.random.Generator) -> Row | None:
    start, hider = game.choose()
    away = _random_pose(space, rng)
    at_step = int(rng.integers(*CARRIED_AT_STEPS))
    done = False

    def carry(status: MissionStatus) -> None:
        nonlocal done
        if not done and status.state == "running" and status.step >= at_step:
            done = True
            game.experimenter.place_robot(away)

    played = game.seek(start, hider, seed, MAX_STEPS, carry)
    return {**_driven(played), "good": played.success or bool(played.run.status.failure)} if done else None


def shut_door(
    game: Game, space: FreeSpace, door_m: tuple[float, float, float], seed: int, rng: np.random.Generator
) -> Row:
    """A bookcase in the only door between robot and hider: blocked, by name; taken away: found."""
    door = Pose(x_m=door_m[0], y_m=door_m[1], yaw_rad=math.radians(door_m[2]))
    start, hider = _either_side(space, door, rng)
    game.client.wait_for_frame(game.experimenter.place_robot(start).stamp_ns)
    game.experimenter.place_obstacle(DOOR, door, DOOR_NAME)
    shut = game.seek(start, hider, seed, MAX_STEPS)
    game.experimenter.set_item(DOOR_NAME, present=False)
    opened = game.seek(game.experimenter.settled_truth().pose, hider, seed, MAX_STEPS)
    return {
        **_driven(opened),
        "failure": shut.run.status.failure,
        "steps": shut.run.status.step + opened.run.status.step,
        "collisions": collisions(shut.run.truths) + collisions(opened.run.truths),
        "good": shut.run.status.failure in ("blocked", "no_path", "lost") and opened.success,
    }


def _either_side(space: FreeSpace, door: Pose, rng: np.random.Generator) -> tuple[Pose, Pose]:
    """Random poses in front of a door and behind it, both at least half a metre away from it."""
    ahead = (math.cos(door.yaw_rad), math.sin(door.yaw_rad))
    found: dict[bool, Pose] = {}
    while len(found) < 2:
        pose = _random_pose(space, rng)
        beyond_m = (pose.x_m - door.x_m) * ahead[0] + (pose.y_m - door.y_m) * ahead[1]
        if abs(beyond_m) > DOOR_APART_M:
            found.setdefault(beyond_m > 0.0, pose)
    return found[True], found[False]


def foreign(stack: Stack, game: Game, map_name: str, picture: Frame, seed: int) -> Row:
    """A goal picture from another world: refused, by name."""
    goal = goal_features(stack.bus, picture)
    run = game.client.run(
        MissionRequest(action="goto", map=map_name, goal=goal, seed=seed, max_steps=MAX_STEPS)
    )
    return {
        **_outcome(run),
        "final_distance_m": None,
        "good": run.status.failure == "goal_not_in_map",
    }


def foreign_pictures(world_name: str, count: int, rng: np.random.Generator) -> list[Frame]:
    """Pictures from random spots of another world, rendered here."""
    world = load_world(world_name)
    space, shoot = free_space(world), camera(world)
    return [shoot(_random_pose(space, rng)) for _ in range(count)]


def summary(rows: list[Row]) -> list[Row]:
    """Per kind: trials, those that ended as they should, collisions."""
    kinds = dict.fromkeys(row["kind"] for row in rows)
    return [
        {
            "kind": kind,
            "trials": sum(row["kind"] == kind for row in rows),
            "good": sum(row["kind"] == kind and row["good"] for row in rows),
            "arrived": sum(row["kind"] == kind and row["outcome"] == "succeeded" for row in rows),
            "collisions": sum(row["collisions"] for row in rows if row["kind"] == kind),
        }
        for kind in kinds
    ]


def _outcome(run: MissionRun) -> Row:
    status = run.status
    return {
        "outcome": status.state,
        "failure": status.failure,
        "steps": status.step,
        "collisions": collisions(run.truths),
    }


def _driven(played: Round) -> Row:
    return {**_outcome(played.run), "final_distance_m": rounded(played.distance_m)}


def _random_pose(space: FreeSpace, rng: np.random.Generator) -> Pose:
    x_m, y_m, yaw_rad = space.random_pose(rng, MARGIN_M)
    return Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad)
