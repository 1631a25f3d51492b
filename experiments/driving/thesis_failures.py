"""Failures of the thesis that show while driving: oscillation near furniture, stuck in a corner."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from experiments.driving.reversals import longest_stay, reversals
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore, figures
from services.launcher.evaluation.rounds import Game, Round
from services.launcher.evaluation.trail import collisions, driven_m
from services.launcher.terminal.output import rounded
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

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


def _play(choice: StackChoice, world: str, map_name: str, rounds: int, seed: int) -> list[Round]:
    with open_stack(choice) as stack:
        game = Game(stack, free_space(load_world(world)), map_name, np.random.default_rng(seed))
        game.begin(seed)
        return [game.play(seed + number, ROUND_STEPS) for number in range(1, rounds + 1)]
