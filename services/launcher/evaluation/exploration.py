"""One exploration of a world, followed and judged on true poses."""

from dataclasses import dataclass

import numpy as np

from services.launcher.client.experimenter import Hand
from services.launcher.client.map_client import require_map
from services.launcher.client.mission import MissionClient, MissionRun, Watch
from services.launcher.client.stack import Stack
from services.launcher.evaluation.components import components
from services.launcher.evaluation.coverage import coverage
from services.launcher.evaluation.environments import environment_of
from services.launcher.evaluation.false_edges import EdgeCheck, check_edges
from services.launcher.evaluation.trail import collisions, driven_m, manual_moves
from services.launcher.evaluation.truth_file import MapTruth, join_truth
from services.launcher.terminal.output import rounded
from shared.messages import MapReply, MissionRequest
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace


@dataclass(frozen=True)
class Exploration:
    """A finished mission explore.

    Attributes:
        final: where the robot really stands after it.
        hand_moves: times the experiment itself moved the robot during the mission.
    """

    run: MissionRun
    graph: MapReply
    truth: MapTruth
    final: Pose
    hand_moves: int


def explore(
    stack: Stack,
    world: str,
    map_name: str,
    seed: int,
    max_steps: int,
    before: MapTruth | None = None,
    watch: Watch | None = None,
) -> Exploration:
    """Reset the simulator, explore, and join the map's nodes to their true poses."""
    with stack.session() as own:
        client, hand = MissionClient(own.bus, own.robot), Hand(own.bus, own.robot)
        client.wait_for_frame(hand.reset(seed).stamp_ns)
        moved = hand.moves
        request = MissionRequest(action="explore", map=map_name, seed=seed, max_steps=max_steps)
        run = client.run(request, watch)
        hand_moves = hand.moves - moved
        final = hand.settled_truth(run.last_seq).pose
        client.collect()
    graph = require_map(stack, map_name)
    truth = join_truth(world, graph.nodes, client.trail, before)
    return Exploration(run, graph, truth, final, hand_moves)


def figures(result: Exploration, space: FreeSpace, map_name: str, seed: int) -> dict[str, object]:
    """The figures of `topnav explore --json`; the keys up to wall_s are fixed."""
    poses, run = result.truth.poses, result.run
    place = environment_of(result.truth.world)
    checks = check_edges(result.graph.edges, poses, space.line_of_sight, place.blind_m)
    positions = np.array([(p.x_m, p.y_m) for p in poses.values()], dtype=np.float64).reshape(-1, 2)
    return {
        "world": result.truth.world,
        "map": map_name,
        "seed": seed,
        "nodes": len(poses),
        "edges": len(result.graph.edges),
        "coverage": rounded(coverage(space.centres_m(), positions, place.covered_m)),
        "components": components(poses, [(e.a, e.b) for e in result.graph.edges]),
        "manual_moves": max(result.hand_moves, manual_moves(run.truths)),
        "collisions": collisions(run.truths),
        "false_edges": sum(check.false for check in checks),
        "steps": run.status.step,
        "wall_s": rounded(run.wall_s, 1),
        "steps_per_s": rounded(run.steps_per_s, 2),
        "driven_m": rounded(driven_m(run.truths), 2),
        "outcome": run.status.state,
        "reason": run.status.reason,
        "final_pose": {k: rounded(v, 9) for k, v in result.final.model_dump().items()},
        "bearing_error_deg": _bearing_errors(checks),
        "false_edge_list": [_false_edge(check) for check in checks if check.false],
    }


def _bearing_errors(checks: list[EdgeCheck]) -> dict[str, float]:
    errors = np.rad2deg([error for check in checks for error in check.errors_rad])
    if not len(errors):
        return {}
    return {
        name: rounded(np.percentile(errors, q), 2) for name, q in (("median", 50), ("p99", 99), ("max", 100))
    }


def _false_edge(check: EdgeCheck) -> dict[str, object]:
    errors = [rounded(np.rad2deg(error), 1) for error in check.errors_rad]
    facts = {"distance_m": rounded(check.distance_m, 2), "errors_deg": errors, "hidden": check.hidden}
    return {"a": check.a, "b": check.b, **facts}
