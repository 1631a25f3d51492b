"""How often a view on a way speaks against where the robot truly is; gates nothing.

SUITE=runs/dev WORLDS=hotel-1-small,hostel-0-small pytest -q -s tests/benchmarks/test_views_on_the_way.py

SUITE is what `topnav suite generated --data-dir SUITE` keeps of its worlds. WAYS shortest ways through each,
20 by default, between nodes drawn by chance, after furniture was moved, or with MOVED=0 before that:
a robot that knows where it is compares every view with the whole map (services/planner/travel/doubts.py).
"""

import itertools
import math
import os
from pathlib import Path

import networkx as nx
import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.travel import doubts
from services.planner.travel.doubts import LOOK_AROUND_M
from services.planner.travel.tracking import COMPARED, Tracker
from shared.mapgraph.local.displacement import Displacement
from shared.messages.sensors import Ranges
from shared.messages.simulation import Pose
from shared.motion.motion import rotated
from simulator.sensors.attitude import LEVEL
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.benchmarks.played_world import PlayedWorld
from tests.unit.services.planner.travel.seen import Maps, Matcher, features

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = [name for name in os.environ.get("WORLDS", "").split(",") if name]
WHEN = "" if os.environ.get("MOVED", "1") == "0" else "-rearranged"
WAYS, SPREAD_M = 20, 0.3
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(4.0,) * 12, max_range_m=4.0)


def spots(played, free, rng):
    """Poses along a way that is the shortest, so far apart as a robot looks around."""
    at = {node: (pose.x_m, pose.y_m) for node, pose in played.poses.items()}
    ways = nx.Graph()
    ways.add_weighted_edges_from((a, b, math.dist(at[a], at[b])) for a, b in played.graph.edges)
    first, last = rng.choice(sorted(nx.node_connected_component(ways, min(ways))), 2, replace=False)
    left_m = 0.0
    for here, there in itertools.pairwise(nx.shortest_path(ways, first, last, "weight")):
        (x, y), (u, v) = at[here], at[there]
        length_m = math.dist(at[here], at[there])
        for way_m in np.arange(left_m, length_m, LOOK_AROUND_M):
            share = float(way_m) / length_m
            pose = Pose(x_m=x + share * (u - x), y_m=y + share * (v - y), yaw_rad=math.atan2(v - y, u - x))
            if free.is_free((pose.x_m, pose.y_m)):
                yield pose
            left_m = float(way_m) + LOOK_AROUND_M
        left_m -= length_m


def about(played, pose):
    """Where that is, relative to the node nearest to it."""
    node, near = min(
        played.poses.items(), key=lambda item: math.dist((item[1].x_m, item[1].y_m), (pose.x_m, pose.y_m))
    )
    ahead_m, left_m = rotated(pose.x_m - near.x_m, pose.y_m - near.y_m, -near.yaw_rad)
    return Displacement(node, ahead_m, left_m, pose.yaw_rad - near.yaw_rad, SPREAD_M)


@pytest.mark.parametrize("name", WORLDS)
def test_how_often_a_view_speaks_against_where_the_robot_is(name, keep, monkeypatch):
    monkeypatch.setattr(doubts, "DOUBTS", 1)
    folder, pipeline = Path(os.environ["SUITE"]) / name, Pipeline(find_profile("sift"))
    played, rng = PlayedWorld(folder, name, pipeline), np.random.default_rng(5)
    world = load_world(str(folder / f"{name}{WHEN}.yaml"))
    camera, free = tilting_camera(world), free_space(world)
    figures = {"ways": int(os.environ.get("WAYS", WAYS)), "views": 0, "against": 0}
    for _ in range(figures["ways"]):
        for pose in spots(played, free, rng):
            tracker = Tracker(DEFAULT, Maps(played.graph), Matcher(), certain=False)
            tracker.observe(Observation(features(), RANGES))
            tracker.stand_at(about(played, pose))
            view = pipeline.features_of(camera(pose, LEVEL))
            tracker.possible(played.found(view, tracker.nearby(), COMPARED), of_map=True)
            figures["views"] += 1
            figures["against"] += tracker.mistaken
    keep(figures)
