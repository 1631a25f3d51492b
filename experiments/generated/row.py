"""What one world of a suite comes to. Pure."""

from collections.abc import Mapping, Sequence
from typing import Any

from experiments.generated.peers import frontier_curve, walk_curve
from experiments.generated.plan import COVERED, WorldPlan
from services.launcher.client.environments import environment_of
from services.launcher.evaluation.coverage_curve import Curve, metres_to
from services.launcher.terminal.output import rounded
from simulator.service_settings import SimulatorSettings
from simulator.world.freespace import FreeSpace
from simulator.world.world_file import WorldFile

Figures = Mapping[str, Any]
RANGE, RANGE_M = "SIMULATOR_RANGE_MAX_M", SimulatorSettings.model_fields["range_max_m"].default
"""How far the robot's distance sensors reach, and so the scanner of the peer."""

OURS, FRONTIER, WALK = "topnav", "nearest frontier, perfect poses", "random walk"
EXPLORED = ("coverage", "driven_m", "steps", "nodes", "edges", "components", "false_edges", "collisions")
PLAYED = ("success", "final_distance_m", "spl", "reason", "failure", "steps", "collisions", "shortest_m")


def curves_of(plan: WorldPlan, world: WorldFile, space: FreeSpace, explored: Figures) -> dict[str, Curve]:
    """Coverage over driven metres, of the exploration and of its two peers.

    Args:
        plan: which world it is.
        world: as it was mapped.
        space: its free floor.
        explored: what `topnav explore --json` has.
    """
    place = environment_of(world)
    start, range_m = (world.start.x_m, world.start.y_m), float(place.variables.get(RANGE, RANGE_M))
    return {
        OURS: [(metres, share) for metres, share in explored["coverage_curve"]],
        FRONTIER: frontier_curve(space, start, place.covered_m, range_m, COVERED),
        WALK: walk_curve(space, start, place.covered_m, COVERED, plan.seed),
    }


def world_row(
    plan: WorldPlan,
    space: FreeSpace,
    explored: Figures,
    curves: Mapping[str, Curve],
    rounds: Sequence[Figures],
    moved: Sequence[Figures],
) -> dict[str, Any]:
    """An entry of "worlds".

    Args:
        plan: which world it is.
        space: its free floor.
        explored: what `topnav explore --json` has.
        curves: of `curves_of`.
        rounds: figures of those played in the world as it was mapped.
        moved: of those played after it was rearranged.
    """
    needed_m = {name: metres_to(curve, COVERED) for name, curve in curves.items()}
    return {
        "kind": plan.kind,
        "seed": plan.seed,
        "size": plan.size,
        "area_m2": rounded(float(space.free.sum()) * space.resolution_m**2, 1),
        **{key: explored[key] for key in EXPLORED},
        "ended": explored["outcome"] == "succeeded",
        "reason": explored["reason"],
        "metres": needed_m[OURS],
        "peer_metres": _metres(needed_m[FRONTIER]),
        "walk_metres": _metres(needed_m[WALK]),
        "coverage_curve": explored["coverage_curve"],
        "rounds": [{key: one[key] for key in PLAYED} for one in rounds],
        "moved": [{key: one[key] for key in PLAYED} for one in moved],
    }


def _metres(driven_m: float | None) -> float | None:
    return None if driven_m is None else rounded(driven_m, 1)
