"""Somebody edits the map under a running mission: it plans anew or ends by name, and nothing dangles."""

from collections.abc import Iterator

import httpx
import networkx as nx
import pytest

from services.launcher.client.experimenter import Experimenter
from services.launcher.client.maps import delete_map, read_map
from services.launcher.client.mission import MissionClient
from services.launcher.client.stack import Stack, StackChoice, open_stack
from shared.messages.maps import DeleteNode, MapRequest
from shared.messages.missions import MissionRequest
from shared.topics import MAP

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(900),
    pytest.mark.usefixtures("patient_sessions"),
]

STEPS = 240
LONGEST = 300


@pytest.fixture(scope="module")
def stack(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stack]:
    """The apartment in lockstep."""
    choice = StackChoice(tmp_path_factory.mktemp("stack"), "apartment", seed=1, lockstep=True)
    with open_stack(choice) as opened:
        yield opened


@pytest.fixture
def client(stack: Stack) -> MissionClient:
    """Follows missions of a robot that has just explored map `small` and is back at its start."""
    client = MissionClient(stack.bus, stack.robot)
    experimenter = Experimenter(stack.bus, stack.robot)
    if read_map(stack, "small") is None:
        client.wait_for_frame(experimenter.reset(1).stamp_ns)
        client.run(MissionRequest(action="explore", map="small", seed=1, max_steps=STEPS))
    client.wait_for_frame(experimenter.reset(1).stamp_ns)
    return client


def goto(client, node, edit, nodes=2):
    """Drive to a node; `edit` is called once with the status when a path over so many nodes stands."""
    seen = []

    def watch(status):
        if not seen and status.state == "running" and len(status.via_points) > nodes:
            seen.append(status)
            edit(status)

    run = client.run(MissionRequest(action="goto", map="small", goal_node=node, max_steps=LONGEST), watch)
    assert seen, f"the mission ended before there was a path: {run.status.reason}"
    return run.status


def farthest(stack):
    """The place with most edges between it and the first one, where the robot starts."""
    found = read_map(stack, "small")
    away = nx.single_source_shortest_path_length(nx.Graph((e.a, e.b) for e in found.edges), 0)
    return max(away, key=lambda node: (away[node], node))


def delete(stack, node):
    operation = DeleteNode(node_id=node)
    stack.bus.ask(
        MAP, MapRequest(action="transact", author="rest", operations=(operation,)), 30.0, map="small"
    )


def test_a_via_point_that_is_deleted_is_not_driven_to(stack, client):
    gone = []

    def edit(status):
        gone.append(status.via_points[1])
        delete(stack, gone[0])

    ended = goto(client, farthest(stack), edit, nodes=3)
    assert ended.state == "succeeded" or ended.failure, ended.reason
    assert gone[0] not in ended.via_points
    found = read_map(stack, "small")
    places = {node.node_id for node in found.nodes}
    assert gone[0] not in places
    assert all(edge.a in places and edge.b in places for edge in found.edges)


def test_a_mission_to_a_place_that_is_deleted_ends_and_says_so(stack, client):
    goal = farthest(stack)
    ended = goto(client, goal, lambda _: delete(stack, goal))
    assert (ended.state, ended.failure) == ("failed", "goal_not_in_map")
    assert str(goal) in ended.reason


def test_a_mission_in_a_map_that_is_renamed_goes_on_in_it(stack, client):
    """Twice at once: the planner may hear of both only when the first new name is gone again."""
    steps = []

    def edit(status):
        steps.append(status.step)
        for old, new in (("small", "hall"), ("hall", "house")):
            url = f"{stack.gateway_url}/api/maps/{old}"
            httpx.patch(url, json={"name": new}, timeout=60.0, trust_env=False).raise_for_status()

    try:
        ended = goto(client, farthest(stack), edit)
        assert ended.state == "succeeded" or ended.failure not in ("goal_not_in_map", ""), ended.reason
        assert ended.map == "house"
        assert ended.step > steps[0] + 1
        assert (
            httpx.get(f"{stack.gateway_url}/api/robots/r1/mission", trust_env=False).json()["map"] == "house"
        )
    finally:
        httpx.patch(f"{stack.gateway_url}/api/maps/house", json={"name": "small"}, trust_env=False)


def test_a_mission_in_a_map_that_is_deleted_ends_and_says_so(stack, client):
    ended = goto(client, farthest(stack), lambda _: delete_map(stack, "small"))
    assert ended.state == "failed"
    assert ended.failure == "goal_not_in_map"
    assert "the map is gone" in ended.reason
