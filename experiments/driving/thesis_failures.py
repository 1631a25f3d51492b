"""Failures of the thesis that show while driving: oscillation near furniture, stuck in a corner."""

import math
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.client.trail import collisions, driven_m
from services.launcher.evaluation.exploration import explore, figures
from services.launcher.evaluation.outcome import Round
from services.launcher.evaluation.rounds import Game
from services.launcher.terminal.output import rounded
from shared.messages.simulation import Truth
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

STEP_M = 0.05
"""Moves are measured between spots at least this far apart: the noise of standing still is no turn."""

BACK_RAD = math.radians(120.0)
"""Sharper than any corner of a way round furniture; straight back is 180."""

STAY_M = 0.6
"""The distance of neighbouring nodes: a robot that stays within it explores nothing."""

EXPLORE_STEPS, ROUND_STEPS = 600, 600
"""Twice what a round of the apartment takes at most: enough for the thesis's rules to show what they do."""

Row = dict[str, Any]


def oscillation(data_dir: Path, world: str, map_name: str, rounds: int, seed: int) -> Row:
    """Turns back per metre in the same rounds: momentary avoidance (thesis section 4.3) against passing."""
    rates = {}
    for name, drive in (("thesis", "thesis"), ("ours", "default")):
        choice = StackChoice(data_dir, world, seed, lockstep=True, environment={"DRIVE_PROFILE": drive})
        played = _play(choice, world, map_name, rounds, seed)
        turns = sum(reversals(r.run.truths) for r in played)
        metres = sum(driven_m(r.run.truths) for r in played)
        rates[name] = {
            "reversals_per_m": rounded(turns / max(metres, 0.1), 3),
            "found": sum(r.success for r in played),
            "driven_m": rounded(metres, 1),
            "collisions": sum(collisions(r.run.truths) for r in played),
        }
    return {"failure": "oscillation near furniture", "world": world, "rounds": rounds, **rates}


def corner(world: str, seed: int) -> Row:
    """Exploration by the thesis's strategies against frontiers, equally many steps."""
    results = {}
    for name, profile in (("thesis", "thesis"), ("ours", "default")):
        with TemporaryDirectory(prefix="topnav-corner-") as folder:
            data_dir = Path(folder)
            choice = StackChoice(data_dir, world, seed, lockstep=True, profile=profile)
            with open_stack(choice) as stack:
                result = explore(stack, world, "corner", seed, EXPLORE_STEPS)
            report = figures(result, free_space(load_world(world)), "corner", seed)
        results[name] = {
            "longest_stay_steps": longest_stay(result.run.truths, STAY_M),
            "coverage": report["coverage"],
            "nodes": report["nodes"],
            "collisions": report["collisions"],
        }
    return {"failure": "exploration stuck in a corner", "world": world, "steps": EXPLORE_STEPS, **results}


def reversals(truths: Sequence[Truth]) -> int:
    """Times the direction of travel changed by more than 120 degrees from one move to the next."""
    count, previous_rad = 0, None
    if not truths:
        return 0
    anchor = truths[0].pose
    for truth in truths[1:]:
        dx, dy = truth.pose.x_m - anchor.x_m, truth.pose.y_m - anchor.y_m
        if math.hypot(dx, dy) < STEP_M:
            continue
        heading_rad = math.atan2(dy, dx)
        if previous_rad is not None and abs(math.remainder(heading_rad - previous_rad, math.tau)) > BACK_RAD:
            count += 1
        previous_rad, anchor = heading_rad, truth.pose
    return count


def longest_stay(truths: Sequence[Truth], radius_m: float) -> int:
    """Most frames in a row within `radius_m` of where they began: a robot stuck in a corner."""
    longest = start = 0
    for end, truth in enumerate(truths):
        while _apart_m(truths[start], truth) > radius_m:
            start += 1
        longest = max(longest, end - start + 1)
    return longest


def _play(choice: StackChoice, world: str, map_name: str, rounds: int, seed: int) -> list[Round]:
    with open_stack(choice) as stack:
        game = Game(stack, free_space(load_world(world)), map_name, np.random.default_rng(seed))
        game.begin(seed)
        return [game.play(seed + number, ROUND_STEPS) for number in range(1, rounds + 1)]


def _apart_m(a: Truth, b: Truth) -> float:
    return math.hypot(b.pose.x_m - a.pose.x_m, b.pose.y_m - a.pose.y_m)
