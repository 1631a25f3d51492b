"""Which nodes a frame can be looking at, by where it was taken. Pure.

The edges around the node that the robot came from say where the others lie relative to it. A place that
repeats, such as the next of many equal desks, claims to be seen from elsewhere: a period further. However
well it resembles, that is out of reach; and yaws round a loop must close.
"""

import math
from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.relative_poses import RelativePose, poses_by_ways, relative_poses
from shared.mapgraph.local.view_range import openness

STDS = 3.0
"""A sight further than so many standard deviations from where its node lies is refused; the usual three."""
YAW_RAD = math.radians(5.0)
"""Yaws may differ by so much more: no true edge of four worlds and an office missed by more than 3
degrees."""
BEARING_RAD = math.radians(4.0)
"""Error of the bearing of a sight, generous: what stands near bends it."""
LENGTH_FACTOR = 2.0
"""A node may be so many times nearer or further than its matches say, beside the usual three deviations: they
tell it to a factor of 1.5 in two of three cases."""
SPOT_M = 0.4
"""Where no baseline is seen the node is this near; and what a length is uncertain by in any case."""
LOOSE_M = 1.0
"""In a room a node hangs on edges that nobody drove where its standard deviation is more; chosen: those that
driven ways lead to have 0.1 to 0.4 m at eight metres, the others two metres and more."""
LOOSE_FACTOR = 2.5
"""How many times further than it is seen such a node may lie: two distances by matches, either right to a
factor of 1.6 in nine of ten cases."""
LOOP_NODES = 400
"""Nodes reckoned with all together where a loop may close; chosen: 250 m of way, in 0.1 s a new node. Others
are reckoned with by the ways to them: with nothing known of those, houses on the other side of a village of
600 nodes were taken for those in front."""


def out_of_reach(
    graph: MapGraph,
    claims: Mapping[int, Claim],
    here: Displacement,
    most: int | None = None,
    longest_m: float = math.inf,
    hidden: Collection[int] = (),
) -> dict[int, str]:
    """Nodes that lie elsewhere than the frame claims, and why.

    Args:
        graph: the map without the frame.
        claims: by node.
        here: where the frame was taken; without its node in the map nothing is known.
        most: nodes of the map reckoned with; of those further off nothing is known, and none is refused.
            None: the whole map, the nearest LOOP_NODES together and others by the ways that lead to them.
        longest_m: what surely lies further away is elsewhere, too.
        hidden: of these what does so by the best estimate is.
    """
    if here.node_id not in graph.nodes or not claims:
        return {}
    poses = relative_poses(graph, here.node_id, claims, LOOP_NODES if most is None else most)
    if most is None and (further := claims.keys() - poses.keys()):
        poses |= poses_by_ways(graph, here.node_id, further)
    judged = {
        node: _contradiction(poses[node], c, here, longest_m, 0.0 if node in hidden else STDS)
        for node, c in claims.items()
        if node in poses
    }
    return {node: f"node {node} {why}" for node, why in judged.items() if why}


def distances_m(graph: MapGraph, here: Displacement, most: int) -> dict[int, float]:
    """How far the nodes around a frame are from it, by where they lie, not by what they look like.

    Args:
        graph: the map.
        here: where the frame was taken; without its node in the map nothing is known.
        most: nodes reckoned with, nearest by number of edges first.
    """
    if here.node_id not in graph.nodes:
        return {}
    poses = relative_poses(graph, here.node_id, graph.nearest(here.node_id, most), most)
    at_m = np.array([here.x_m, here.y_m])
    return {node: float(np.linalg.norm(pose.position_m - at_m)) for node, pose in poses.items()}


def hanging_apart(graph: MapGraph, claims: Mapping[int, Claim], here: Displacement, most: int) -> set[int]:
    """Nodes seen that hang on edges which nobody drove, and lie much nearer or further than they are seen.

    Three deviations of where such a node lies are many metres: any look-alike would be in reach. But the
    matches of those edges tell how long they are as well as those of the frame do.

    Args:
        graph: the map without the frame.
        claims: by node.
        here: where the frame was taken; without its node in the map nothing is known.
        most: nodes reckoned with, nearest by number of edges first.
    """
    if here.node_id not in graph.nodes:
        return set()
    poses = relative_poses(graph, here.node_id, claims, most)
    loose_m, at_m = LOOSE_M * openness(graph, here.node_id), np.array([here.x_m, here.y_m])
    apart = set()
    for node, pose in poses.items():
        if claims[node].heading_rad is None or np.linalg.eigvalsh(pose.covariance_m2)[-1] < loose_m**2:
            continue
        far_m = float(np.linalg.norm(pose.position_m - at_m))
        if abs(math.log(max(far_m, SPOT_M) / claims[node].length_m)) > math.log(LOOSE_FACTOR):
            apart.add(node)
    return apart


def _contradiction(
    pose: RelativePose, claim: Claim, here: Displacement, longest_m: float, stds: float
) -> str:
    """Why the node cannot be where the frame sees it; "" when it can.

    It is too far when it lies beyond `longest_m` by so many standard deviations.
    """
    yaw_miss = abs(math.remainder(here.yaw_rad + claim.yaw_rad - pose.yaw_rad, math.tau))
    if yaw_miss > YAW_RAD + STDS * math.hypot(pose.yaw_std_rad, here.yaw_std_rad):
        return f"would be turned by {math.degrees(yaw_miss):.0f} degrees: yaws round the loop do not close"
    gap = pose.position_m - np.array([here.x_m, here.y_m])
    covariance = pose.covariance_m2 + here.spread_m**2 * np.eye(2)
    far_m = float(np.linalg.norm(gap))
    if claim.heading_rad is None:
        spread_m = math.hypot(SPOT_M, _std(covariance, gap / max(far_m, 1e-6)))
        return f"is {far_m:.1f} m from here, seen as this very spot" if far_m > STDS * spread_m else ""
    if far_m - stds * _std(covariance, gap / max(far_m, 1e-6)) > longest_m:
        return f"is {far_m:.1f} m from here: too far"
    angle_rad = here.yaw_rad + claim.heading_rad
    along = np.array([math.cos(angle_rad), math.sin(angle_rad)])
    across = np.array([-along[1], along[0]])
    claimed_m = claim.length_m
    least_m, most_m = claimed_m / LENGTH_FACTOR - SPOT_M, claimed_m * LENGTH_FACTOR + SPOT_M
    ahead_m, aside_m = float(gap @ along), float(gap @ across)
    beyond = max(least_m - ahead_m, ahead_m - most_m, 0.0) / max(_std(covariance, along), 1e-6)
    bearing_m = max(BEARING_RAD, claim.heading_std_rad, here.yaw_std_rad) * far_m
    aside = aside_m / math.hypot(_std(covariance, across), bearing_m, SPOT_M / STDS)
    if math.hypot(beyond, aside) <= STDS:
        return ""
    return f"is {far_m:.1f} m from here, seen {claimed_m:.1f} m away and {abs(aside_m):.1f} m aside"


def _std(covariance: npt.NDArray[np.float64], axis: npt.NDArray[np.float64]) -> float:
    return float(np.sqrt(axis @ covariance @ axis))
