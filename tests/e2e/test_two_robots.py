"""Two robots of one stack map the same flat at once, and each finds its way in what the other has seen."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass

import pytest

from services.launcher.client.maps import require_map
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.client.trail import collisions
from services.launcher.evaluation.map_quality import check_edges, components
from services.launcher.evaluation.truth_file import join_truth
from shared.bus import wait_until
from shared.messages.maps import MapReply
from shared.messages.missions import MissionRequest
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.fleet import Robot, another_robot, taking_part

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

WORLD, MAP, FIRST, SECOND = "apartment", "flat", "r1", "r2"
ALONE = {"action": "explore", "map": MAP, "max_steps": 24}
TOGETHER = {"action": "explore", "map": MAP, "max_steps": 40}
"""Too few steps for the whole apartment, so that nobody is ready before the other."""


@dataclass(frozen=True)
class Shared:
    """What the two did.

    Attributes:
        made: the places that each told of.
        poses: where every place of the map truly is.
        wanted: the place of the first robot that the second drove to at last.
    """

    robots: dict[str, Robot]
    made: dict[str, list[int]]
    graph: MapReply
    poses: dict[int, Pose]
    wanted: int


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shared]:
    """One begins; the other joins it in its map, then drives to a place of the first, which maps on."""
    folder = tmp_path_factory.mktemp("two")
    sharing = {"FEATURES_ROBOTS": f"{FIRST},{SECOND}"}
    choice = StackChoice(folder, WORLD, seed=1, lockstep=True, environment=sharing)
    with ExitStack() as open_:
        stack = open_.enter_context(open_stack(choice))
        open_.enter_context(another_robot(stack, SECOND, WORLD, folder))
        robots = {name: open_.enter_context(taking_part(stack, name)) for name in (FIRST, SECOND)}
        first, second = robots.values()
        threads = open_.enter_context(ThreadPoolExecutor(2))
        first.client.wait_for_frame(first.experimenter.reset(seed=1).stamp_ns)
        first.run(**ALONE)
        begun = first.made()
        start = join_truth(WORLD, require_map(stack, MAP).nodes, first.client.trail, None).poses[begun[0]]
        second.client.wait_for_frame(second.experimenter.place_robot(turned(start)).stamp_ns)
        list(threads.map(lambda each: each.run(**TOGETHER), robots.values()))
        mapping = threads.submit(first.run, **ALONE)
        second.run(action="goto", map=MAP, goal_node=max(begun), max_steps=200)
        mapping.result()
        first.run(**ALONE)  # writes that the second hears of while it has nothing to do
        graph = require_map(stack, MAP)
        made = {FIRST: begun + first.made(), SECOND: second.made()}
        poses: dict[int, Pose] = {}
        for name, each in robots.items():
            each.client.collect()
            own = [node for node in graph.nodes if node.node_id in made[name]]
            poses |= join_truth(WORLD, own, each.client.trail, None).poses
        yield Shared(robots, made, graph, poses, max(begun))


def turned(pose: Pose) -> Pose:
    """The same spot, looking elsewhere."""
    return pose.model_copy(update={"yaw_rad": math.remainder(pose.yaw_rad + 1.0, math.tau)})


def test_every_place_that_either_made_is_in_the_map_under_an_id_of_its_own(shared):
    told = [node_id for ids in shared.made.values() for node_id in ids]
    assert sorted(told) == sorted(node.node_id for node in shared.graph.nodes)
    assert all(len(ids) >= 3 for ids in shared.made.values()), shared.made


def test_their_places_are_joined_to_one_map_without_a_false_edge(shared):
    space, edges = free_space(load_world(WORLD)), shared.graph.edges
    between = [edge for edge in edges if (edge.a in shared.made[FIRST]) != (edge.b in shared.made[FIRST])]
    assert len(between) >= 2, "each has recognised places of the other"
    assert components(shared.poses, [(edge.a, edge.b) for edge in edges]) == 1
    assert [check for check in check_edges(edges, shared.poses, space.in_view) if check.false] == []


@pytest.mark.parametrize("name", [FIRST, SECOND])
def test_both_planners_know_the_whole_map_in_the_end(shared, name):
    def known():
        status = shared.robots[name].client.ask(MissionRequest(action="status"))
        return status.nodes, status.edges

    stored = len(shared.graph.nodes), len(shared.graph.edges)
    assert wait_until(lambda: known() == stored, 60.0, 0.2), (known(), stored)


@pytest.mark.parametrize("name", [FIRST, SECOND])
def test_both_went_on_to_the_end_of_each_mission_without_a_collision(shared, name):
    runs = shared.robots[name].runs
    ended = [run.status.failure for run in runs if run.status.action == "explore"]
    assert set(ended) == {"timeout"}, [run.status.reason for run in runs]
    assert sum(collisions(run.truths) for run in runs) == 0


def test_the_second_drives_to_a_picture_of_the_first_that_still_maps(shared):
    run, goal = shared.robots[SECOND].runs[-1], shared.poses[shared.wanted]
    assert run.status.state == "succeeded", run.status.reason
    final = run.truths[-1].pose
    assert math.dist((final.x_m, final.y_m), (goal.x_m, goal.y_m)) < 0.5
