"""Merging two maps through the gateway: a real map store, matches answered from known poses."""

import threading
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from shared.bus import Bus, wait_until
from shared.messages.maps import AddNode, Edge, MapReply, MapRequest, Node, Operation, PutEdge, UpdateNode
from shared.messages.matching import MatchReply, MatchRequest, NodeMatch
from shared.topics import MAP, MATCH
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, free_port
from tests.integration.gateway.standins import Peer
from tests.integration.map_store.conftest import START_S, Process
from tests.merge_world import (
    KEYPOINTS,
    PIPELINE,
    Pose,
    apart_m,
    edges_of,
    features_of,
    match,
    matches_of,
    row,
    seen,
)

REPOSITORY = Path(__file__).resolve().parents[3]
END_S = 60.0
RNG = np.random.default_rng(5)
HALL = dict(enumerate(row(RNG, 0.0, 0.0, 8)))
WING = {5 * k + 2: pose for k, pose in enumerate(row(RNG, 5.2, 0.3, 7))}
YARD = {k: pose.moved(0.0, 40.0) for k, pose in enumerate(row(RNG, 0.0, 0.0, 5))}
FIRST = 1_000
"""Features of place n of the wing have the number FIRST + n, those of the yard twice that."""


class Matcher:
    """Answers MATCH about the hall; `hold` keeps the answers back, `before` is called ahead of each."""

    def __init__(self) -> None:
        self.hold = threading.Event()
        self.before: Callable[[int], None] = lambda _number: None
        self.asked = 0
        self.known: dict[int, tuple[NodeMatch, ...]] = {}
        for first, poses in ((FIRST, WING), (2 * FIRST, YARD)):
            found = matches_of(HALL, poses, np.random.default_rng(0))
            self.known |= {first + n: tuple(one) for n, one in found.items()}
        stray = match(1, HALL[1].moved(1.0, 0.0), HALL[1], np.random.default_rng(0))
        self.known[2 * FIRST] = (stray,)

    def setup(self, bus: Bus) -> Callable[[], None]:
        """Serve."""
        requests = bus.requests(MATCH, robot="r1")

        def turn() -> None:
            while not self.hold.is_set() and (question := requests.take()) is not None:
                self.asked += 1
                self.before(self.asked)
                features = question.message.features
                if features is None or features.seq not in self.known:
                    question.refuse("node 0 was made by another pipeline")
                else:
                    question.reply(self._answer(question.message, self.known[features.seq]))

        return turn

    @staticmethod
    def _answer(wish: MatchRequest, results: tuple[NodeMatch, ...]) -> MatchReply:
        assert (wish.best_k, wish.with_matches) == (5, False)
        return MatchReply(map=wish.map, pipeline=PIPELINE, max_similarity=150, results=results)


@pytest.fixture(scope="module")
def matcher(endpoint: str) -> Iterator[Matcher]:
    service = Matcher()
    with Peer(endpoint, "features", service.setup):
        yield service


@pytest.fixture(scope="module")
def address(
    endpoint: str, robot_bus: Bus, matcher: Matcher, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[str]:
    """A gateway beside a real map store."""
    assert matcher
    process = Process(REPOSITORY, tmp_path_factory.mktemp("maps"), endpoint, free_port(), patient=True)
    process.start()
    try:
        assert wait_until(lambda: robot_bus.alive("map_store") != [], START_S)
        folder = tmp_path_factory.mktemp("runs")
        beside = ("features", "map_store")
        yield from serve_gateway(endpoint, beside, map_store_url=process.url, robot="r1", runs_dir=folder)
    finally:
        process.kill()


@pytest.fixture
def http(address: str, robot_bus: Bus, matcher: Matcher) -> Iterator[httpx.Client]:
    """A client; the maps hall, wing and yard are made anew."""
    matcher.hold.clear()
    matcher.before, matcher.asked = lambda _number: None, 0
    with httpx.Client(base_url=address, trust_env=False, timeout=2 * WAIT_S) as client:
        for name, poses, first in (("hall", HALL, 0), ("wing", WING, FIRST), ("yard", YARD, 2 * FIRST)):
            client.delete(f"/api/maps/{name}")
            ask(robot_bus, name, action="create")
            ask(robot_bus, name, action="transact", operations=tuple(made(poses, first)))
        yield client
        matcher.hold.clear()
        client.delete("/api/maps/hall/merge")


def made(poses: Mapping[int, Pose], first: int, pipeline: str = PIPELINE) -> list[Operation]:
    adds = [
        AddNode(
            node=Node(node_id=n, stamp_ns=7 + n, pipeline=pipeline, keypoints=KEYPOINTS, open=(True,) * 12),
            features=features_of(first + n),
        )
        for n in poses
    ]
    edges = edges_of(poses, np.random.default_rng(0))
    return [*adds, *(PutEdge(edge=edge.model_copy(update={"traversals": 3})) for edge in edges)]


def ask(bus: Bus, name: str, **fields: Any) -> MapReply:
    return bus.ask(MAP, MapRequest(**fields), WAIT_S, map=name)


def merge(http: httpx.Client, name: str, other: str) -> dict[str, Any]:
    """Merge and wait for the end."""
    answer = http.post(f"/api/maps/{name}/merge", json={"other": other})
    assert answer.status_code == 202, answer.text
    assert answer.headers["location"] == f"/api/maps/{name}/merge"
    return ended(http, name)


def ended(http: httpx.Client, name: str) -> dict[str, Any]:
    assert wait_until(lambda: look(http, name)["state"] not in ("matching", "writing"), END_S)
    return look(http, name)


def look(http: httpx.Client, name: str) -> dict[str, Any]:
    answer: dict[str, Any] = http.get(f"/api/maps/{name}/merge").json()
    return answer


def test_the_shared_part_joins_the_maps_in_one_revision(http: httpx.Client, robot_bus: Bus) -> None:
    told = merge(http, "hall", "wing")
    assert told == {
        "map": "hall",
        "other": "wing",
        "state": "done",
        "matched": len(WING),
        "nodes": len(WING),
        "edges": len(edges_of(WING, RNG)),
        "cross_edges": told["cross_edges"],
        "reason": "",
    }
    whole = ask(robot_bus, "hall", action="read")
    assert whole.revision == 2
    poses = HALL | {8 + k: WING[n] for k, n in enumerate(WING)}
    assert {node.node_id for node in whole.nodes} == set(poses)
    across = [edge for edge in whole.edges if edge.why == "merged"]
    assert len(across) == told["cross_edges"] >= 6
    assert all(edge.a < 8 <= edge.b for edge in across)
    assert all(apart_m(poses[edge.a], poses[edge.b]) < 1.6 for edge in across)
    for edge in whole.edges:
        assert points(edge, poses)
    assert ask(robot_bus, "wing", action="read").revision == 1


def points(edge: Edge, poses: Mapping[int, Pose]) -> bool:
    there, turned = seen(poses[edge.a], poses[edge.b])
    back, _ = seen(poses[edge.b], poses[edge.a])
    told = (edge.heading_ab_rad, edge.yaw_ab_rad, edge.heading_ba_rad)
    return told == pytest.approx((there, turned, back), abs=1e-6)


def test_places_keep_what_they_look_like_and_what_is_known_of_them(
    http: httpx.Client, robot_bus: Bus
) -> None:
    merge(http, "hall", "wing")
    whole = ask(robot_bus, "hall", action="read")
    features = {
        part.node_id: part.features for part in ask(robot_bus, "hall", action="read_features").features
    }
    for new, old in enumerate(WING, start=8):
        node = next(node for node in whole.nodes if node.node_id == new)
        assert (node.stamp_ns, node.open) == (7 + old, (True,) * 12)
        np.testing.assert_array_equal(features[new].descriptors, features_of(FIRST + old).descriptors)
        picture = http.get(f"/api/maps/hall/nodes/{new}/thumbnail").content
        assert picture == features_of(FIRST + old).thumbnail
    assert {edge.traversals for edge in whole.edges if edge.why == "seen"} == {3}


@pytest.mark.parametrize(("headers", "author"), [({"X-Topnav-Author": "anna"}, "anna"), ({}, "gateway")])
def test_a_merge_is_made_in_the_name_of_who_asked(
    http: httpx.Client, headers: dict[str, str], author: str
) -> None:
    assert http.post("/api/maps/hall/merge", json={"other": "wing"}, headers=headers).status_code == 202
    assert ended(http, "hall")["state"] == "done"
    assert http.get("/api/maps/hall/revisions").json()[0]["author"] == author


def test_an_undo_takes_the_whole_merge_back(http: httpx.Client, robot_bus: Bus) -> None:
    before = ask(robot_bus, "hall", action="read")
    merge(http, "hall", "wing")
    assert http.post("/api/maps/hall/undo").status_code == 200
    after = ask(robot_bus, "hall", action="read")
    assert (set(after.nodes), set(after.edges)) == (set(before.nodes), set(before.edges))


def test_maps_that_share_no_place_stay_as_they_are(http: httpx.Client, robot_bus: Bus) -> None:
    told = merge(http, "hall", "yard")
    assert (told["state"], told["matched"], told["cross_edges"]) == ("refused", 5, 0)
    assert told["reason"] == "the maps share no place: 1 of 5 look alike, none is supported"
    assert ask(robot_bus, "hall", action="read").revision == 1


def test_a_map_that_changes_meanwhile_is_not_overwritten(
    http: httpx.Client, robot_bus: Bus, matcher: Matcher
) -> None:
    def change(number: int) -> None:
        if number == 3:
            moved = Node(node_id=0, pipeline=PIPELINE)
            ask(robot_bus, "hall", action="transact", operations=(UpdateNode(node=moved),))

    matcher.before = change
    told = merge(http, "hall", "wing")
    assert told["state"] == "refused"
    assert "map 'hall' is at revision 2, not 1" in told["reason"]
    now = ask(robot_bus, "hall", action="read")
    assert (now.revision, len(now.nodes)) == (2, len(HALL))


def test_one_merge_at_a_time_and_a_cancelled_one_writes_nothing(
    http: httpx.Client, robot_bus: Bus, matcher: Matcher
) -> None:
    matcher.hold.set()
    assert http.post("/api/maps/hall/merge", json={"other": "wing"}).json()["state"] == "matching"
    second = http.post("/api/maps/yard/merge", json={"other": "wing"})
    assert (second.status_code, second.json()["title"]) == (409, "merge running")
    told = http.delete("/api/maps/hall/merge").json()
    assert (told["state"], told["reason"]) == ("refused", "cancelled: nothing was written")
    assert http.delete("/api/maps/hall/merge").json() == told
    matcher.hold.clear()
    assert merge(http, "hall", "wing")["state"] == "done"
    assert ask(robot_bus, "hall", action="read").revision == 2


def test_a_feature_service_that_refuses_is_the_reason(http: httpx.Client, robot_bus: Bus) -> None:
    wrong = [step for step in made(WING, FIRST) if isinstance(step, AddNode)][:1]
    other = wrong[0].model_copy(update={"features": features_of(9_999)})
    http.delete("/api/maps/stray")
    ask(robot_bus, "stray", action="create")
    ask(robot_bus, "stray", action="transact", operations=(other,))
    told = merge(http, "hall", "stray")
    assert told["state"] == "refused"
    assert "another pipeline" in told["reason"]


@pytest.mark.parametrize(
    ("name", "other", "status", "title"),
    [
        ("hall", "nowhere", 404, "unknown map"),
        ("nowhere", "wing", 404, "unknown map"),
        ("hall", "hall", 422, "same map"),
        ("hall", "..", 422, "invalid request"),
    ],
)
def test_what_cannot_be_merged_is_a_problem(
    http: httpx.Client, name: str, other: str, status: int, title: str
) -> None:
    answer = http.post(f"/api/maps/{name}/merge", json={"other": other})
    assert (answer.status_code, answer.json()["title"]) == (status, title)


def test_maps_of_two_pipelines_cannot_be_merged(http: httpx.Client, robot_bus: Bus) -> None:
    http.delete("/api/maps/orbs")
    ask(robot_bus, "orbs", action="create")
    ask(robot_bus, "orbs", action="transact", operations=tuple(made(WING, FIRST, "orb/1")))
    answer = http.post("/api/maps/hall/merge", json={"other": "orbs"})
    assert (answer.status_code, answer.json()["title"]) == (409, "pipelines differ")
    assert answer.json()["got"] == f"orb/1, {PIPELINE}"


@pytest.mark.parametrize("method", ["GET", "DELETE"])
def test_a_map_that_none_was_merged_into_has_no_merge(http: httpx.Client, method: str) -> None:
    answer = http.request(method, "/api/maps/wing/merge")
    assert (answer.status_code, answer.json()["title"]) == (404, "no merge")
