"""One exploration of a world, followed and judged on true poses."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.launcher.client.environments import environment_of, robot_base
from services.launcher.client.experimenter import Experimenter
from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import delete_map, read_map, require_map
from services.launcher.client.mission import MissionClient, MissionRun
from services.launcher.client.stack import Stack
from services.launcher.client.trail import collisions, driven_m, manual_moves
from services.launcher.evaluation.coverage_curve import Curve, coverage_curve
from services.launcher.evaluation.map_quality import EdgeCheck, check_edges, components, coverage
from services.launcher.evaluation.truth_file import MapTruth, join_truth, load_truth
from services.launcher.terminal.output import rounded
from services.launcher.terminal.progress import Watch
from shared.messages.maps import MapReply
from shared.messages.missions import MissionRequest
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace


@dataclass(frozen=True)
class Exploration:
    """A finished mission explore.

    Attributes:
        final: where the robot really stands after it.
        experimenter_moves: times the experiment itself moved the robot during the mission.
    """

    run: MissionRun
    graph: MapReply
    truth: MapTruth
    final: Pose
    experimenter_moves: int


def make_room(stack: Stack, map_name: str, truth_file: Path, *, go_on: bool, fresh: bool) -> MapTruth | None:
    """Make room for a map, or return the truth of the one to go on with.

    Raises:
        ExperimentError: there is one, and neither was wished for.
    """
    found = read_map(stack, map_name)
    if found is not None and found.nodes and not (go_on or fresh):
        raise ExperimentError(
            f"map {map_name!r} exists with {len(found.nodes)} nodes: go on with it (--continue), "
            "delete it first (--fresh), or choose another name (--map)"
        )
    if fresh:
        if found is not None:
            delete_map(stack, map_name)
        truth_file.unlink(missing_ok=True)
        return None
    return load_truth(truth_file) if found is not None else None


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
        client, experimenter = MissionClient(own.bus, own.robot), Experimenter(own.bus, own.robot)
        client.wait_for_frame(experimenter.reset(seed).stamp_ns)
        moved = experimenter.moves
        wish = {"covers_m": environment_of(world).covered_m}
        request = MissionRequest(
            action="explore", map=map_name, seed=seed, max_steps=max_steps, parameters=wish
        )
        run = client.run(request, watch)
        moved = experimenter.moves - moved
        final = experimenter.settled_truth(run.last_seq).pose
        client.collect()
    graph = require_map(stack, map_name)
    truth = join_truth(world, graph.nodes, client.trail, before)
    return Exploration(run, graph, truth, final, moved)


def figures(result: Exploration, space: FreeSpace, map_name: str, seed: int) -> dict[str, object]:
    """The figures of `topnav explore --json`; the keys up to wall_s are fixed."""
    poses, run = result.truth.poses, result.run
    place = environment_of(result.truth.world)
    checks = check_edges(result.graph.edges, poses, space.in_view, place.blind_m)
    positions = np.array([(p.x_m, p.y_m) for p in poses.values()], dtype=np.float64).reshape(-1, 2)
    return {
        "world": result.truth.world,
        "map": map_name,
        "seed": seed,
        "base": robot_base(),
        "nodes": len(poses),
        "edges": len(result.graph.edges),
        "coverage": rounded(coverage(space.centres_m(), positions, place.covered_m)),
        "components": components(poses, [(e.a, e.b) for e in result.graph.edges]),
        "manual_moves": max(result.experimenter_moves, manual_moves(run.truths)),
        "collisions": collisions(run.truths),
        "false_edges": sum(check.false for check in checks),
        "steps": run.status.step,
        "wall_s": rounded(run.wall_s, 1),
        "steps_per_s": rounded(run.steps_per_s, 2),
        "driven_m": rounded(driven_m(run.truths), 2),
        "coverage_curve": [[rounded(metres, 2), rounded(share)] for metres, share in curve(result, space)],
        "outcome": run.status.state,
        "reason": run.status.reason,
        "final_pose": {k: rounded(v, 9) for k, v in result.final.model_dump().items()},
        "bearing_error_deg": _bearing_errors(checks),
        "false_edge_list": [_false_edge(check) for check in checks if check.false],
    }


def curve(result: Exploration, space: FreeSpace) -> Curve:
    """Driven metres and coverage after each node."""
    radius_m = environment_of(result.truth.world).covered_m
    return coverage_curve(space.centres_m(), result.truth, result.run.truths, radius_m)


def _bearing_errors(checks: list[EdgeCheck]) -> dict[str, float]:
    errors = np.rad2deg([error for check in checks for error in check.errors_rad])
    if not len(errors):
        return {}
    percentiles = (("median", 50), ("p99", 99), ("max", 100))
    return {name: rounded(np.percentile(errors, q), 2) for name, q in percentiles}


def _false_edge(check: EdgeCheck) -> dict[str, object]:
    errors = [rounded(np.rad2deg(error), 1) for error in check.errors_rad]
    facts = {"distance_m": rounded(check.distance_m, 2), "errors_deg": errors, "hidden": check.hidden}
    return {"a": check.a, "b": check.b, **facts}
