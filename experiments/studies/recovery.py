"""`topnav study recovery`: the robot is carried away mid-mission, or asked for a place that is elsewhere."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import typer

from experiments import options
from experiments.failure import one_line_errors
from experiments.map_client import require_map
from experiments.output import rounded, write_json
from experiments.rounds import ARRIVED_M, EXTRACT_TIMEOUT_S, MARGIN_M, Game, Round
from experiments.stack import Stack, StackChoice, open_stack
from experiments.studies.pair_features import camera_settings
from experiments.tables import print_rows
from experiments.trail import collisions
from shared.messages import ExtractRequest, MissionRequest, MissionStatus
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from shared.topics import EXTRACT
from simulator.freespace import FreeSpace, free_space
from simulator.world_file import load_world

CARRIED_AT_STEPS = (5, 40)
MAX_STEPS = 1500

Row = dict[str, Any]


def main(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    elsewhere: Annotated[str, typer.Option(help="World that the foreign pictures come from.")] = "break_room",
    trials: Annotated[int, typer.Option(min=1, help="Trials of each kind.")] = 10,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Ten robots carried away, ten pictures from elsewhere: each must end well or say by name why not."""
    rng = np.random.default_rng(seed)
    rows: list[Row] = []
    with one_line_errors(), open_stack(StackChoice(data_dir, world, seed, lockstep=True)) as stack:
        require_map(stack, map_name)
        game = Game(stack, free_space(load_world(world)), map_name, rng)
        game.begin(seed)
        pictures = foreign_pictures(elsewhere, trials, rng)
        kinds: dict[str, Callable[[int], Row]] = {
            "carried": lambda n: carried(game, free_space(load_world(world)), seed + n, rng),
            "foreign": lambda n: foreign(stack, game, map_name, pictures[n], seed + n),
        }
        for kind, trial in kinds.items():
            for number in range(trials):
                rows.append({"kind": kind, "trial": number + 1, **trial(number)})
                if json_file is not None:
                    write_json(
                        json_file, {"world": world, "seed": seed, "trials": rows, "summary": summary(rows)}
                    )
    print_rows("trials", rows)
    print_rows("summary", summary(rows))


def carried(game: Game, space: FreeSpace, seed: int, rng: np.random.Generator) -> Row:
    """A round in which the robot is put elsewhere after a few steps."""
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
    return {**_outcome(played), "carried": done, "good": played.success or bool(played.run.status.failure)}


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
        "within_m": ARRIVED_M,
    }
