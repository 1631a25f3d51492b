"""`topnav study recovery`: a robot that is carried away, a goal that is elsewhere, a door that was shut."""

import math
from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import typer

from experiments.studies.rendered_views import camera_settings
from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.map_client import require_map
from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.evaluation.rounds import EXTRACT_TIMEOUT_S, MARGIN_M, Game, Round
from services.launcher.evaluation.trail import collisions
from services.launcher.terminal import options
from services.launcher.terminal.output import rounded, write_json
from services.launcher.terminal.tables import print_rows
from shared.messages import ExtractRequest, MissionRequest, MissionStatus
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from shared.topics import EXTRACT
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

TRIES = 10
CARRIED_AT_STEPS = (5, 40)
MAX_STEPS = 1500
KINDS = ("carried", "foreign", "shut-door")
DOOR, DOOR_NAME, DOOR_APART_M = "bookshelf", "shut door", 0.5

Row = dict[str, Any]


def main(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    elsewhere: Annotated[str, typer.Option(help="World that the foreign pictures come from.")] = "village",
    door_m: Annotated[
        tuple[float, float, float], typer.Option(help="Middle of the only door and its heading (degrees).")
    ] = (1.65, -0.1, 90.0),
    trials: Annotated[int, typer.Option(min=1, help="Trials of each kind.")] = 10,
    only: Annotated[str, typer.Option(help=f"One of {', '.join(KINDS)}; default: all.")] = "",
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Carried robots, pictures from elsewhere, a shut door: each ends well or says by name why not."""
    if only and only not in KINDS:
        raise typer.BadParameter(f"--only must be one of {', '.join(KINDS)}, got {only!r}")
    rng = np.random.default_rng(seed)
    rows: list[Row] = []
    with one_line_errors(), open_stack(StackChoice(data_dir, world, seed, lockstep=True)) as stack:
        require_map(stack, map_name)
        space = free_space(load_world(world))
        game = Game(stack, space, map_name, rng)
        game.begin(seed)
        pictures = foreign_pictures(elsewhere, trials, rng) if only in ("", "foreign") else []
        kinds: dict[str, Callable[[int], Row]] = {
            "carried": lambda n: carried(game, space, seed + n, rng),
            "foreign": lambda n: foreign(stack, game, map_name, pictures[n], seed + n),
            "shut-door": lambda n: shut_door(game, space, door_m, seed + n, rng),
        }
        for kind in (only,) if only else KINDS:
            trial = kinds[kind]
            for number in range(trials):
                rows.append({"kind": kind, "trial": number + 1, **trial(number)})
                if json_file is not None:
                    write_json(
                        json_file, {"world": world, "seed": seed, "trials": rows, "summary": summary(rows)}
                    )
    print_rows("trials", rows)
    print_rows("summary", summary(rows))
    return len(rows)


def carried(game: Game, space: FreeSpace, seed: int, rng: np.random.Generator) -> Row:
    """A round in which the robot is put elsewhere after a few steps; a shorter round is played again."""
    for _ in range(TRIES):
        row = _carried_once(game, space, seed, rng)
        if row is not None:
            return row
    raise ExperimentError(f"{TRIES} rounds ended before the robot could be carried: choose another --seed")


def _carried_once(game: Game, space: FreeSpace, seed: int, rng: np.random.Generator) -> Row | None:
    start, hider = game.choose()
    away = Pose(**dict(zip(("x_m", "y_m", "yaw_rad"), space.random_pose(rng, MARGIN_M), strict=True)))
    at_step = int(rng.integers(*CARRIED_AT_STEPS))
    done = False

    def carry(status: MissionStatus) -> None:
        nonlocal done
        if not done and status.state == "running" and status.step >= at_step:
            done = True
            game.hand.place_robot(away)

    played = game.seek(start, hider, seed, MAX_STEPS, carry)
    return {**_outcome(played), "good": played.success or bool(played.run.status.failure)} if done else None


def shut_door(
    game: Game, space: FreeSpace, door_m: tuple[float, float, float], seed: int, rng: np.random.Generator
) -> Row:
    """A bookcase in the only door between robot and hider: blocked, by name; taken away: found."""
    door = Pose(x_m=door_m[0], y_m=door_m[1], yaw_rad=math.radians(door_m[2]))
    start, hider = _either_side(space, door, rng)
    game.client.wait_for_frame(game.hand.place_robot(start).stamp_ns)
    game.hand.place_obstacle(DOOR, door, DOOR_NAME)
    shut = game.seek(start, hider, seed, MAX_STEPS)
    game.hand.set_item(DOOR_NAME, present=False)
    opened = game.seek(game.hand.settled_truth().pose, hider, seed, MAX_STEPS)
    return {
        **_outcome(opened),
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
        x_m, y_m, yaw_rad = space.random_pose(rng, MARGIN_M)
        beyond_m = (x_m - door.x_m) * ahead[0] + (y_m - door.y_m) * ahead[1]
        if abs(beyond_m) > DOOR_APART_M:
            found.setdefault(beyond_m > 0.0, Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad))
    return found[True], found[False]


def foreign(stack: Stack, game: Game, map_name: str, picture: Frame, seed: int) -> Row:
    """A goal picture from another world: refused, by name."""
    goal = stack.bus.ask(EXTRACT, ExtractRequest(frame=picture), EXTRACT_TIMEOUT_S)
    run = game.client.run(
        MissionRequest(action="goto", map=map_name, goal=goal, seed=seed, max_steps=MAX_STEPS)
    )
    status = run.status
    return {
        "outcome": status.state,
        "failure": status.failure,
        "steps": status.step,
        "collisions": collisions(run.truths),
        "final_distance_m": None,
        "good": status.failure == "goal_not_in_map",
    }


def foreign_pictures(world_name: str, count: int, rng: np.random.Generator) -> list[Frame]:
    """Pictures from random places of another world, rendered here."""
    from simulator.simulation import Simulation

    world = load_world(world_name)
    space, simulation = free_space(world), Simulation(world, camera_settings())
    frames = []
    for _ in range(count):
        picture = simulation.panorama_at(*space.random_pose(rng, MARGIN_M))
        height_px, width_px = picture.shape[:2]
        frames.append(
            Frame(
                robot="elsewhere",
                encoding="bgr8",
                width_px=width_px,
                height_px=height_px,
                data=picture.tobytes(),
            )
        )
    return frames


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


def _outcome(played: Round) -> Row:
    status = played.run.status
    return {
        "outcome": status.state,
        "failure": status.failure,
        "steps": status.step,
        "collisions": collisions(played.run.truths),
        "final_distance_m": rounded(played.distance_m),
    }
