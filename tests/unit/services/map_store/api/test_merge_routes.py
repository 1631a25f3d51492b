"""REST of merging: what can be started, looked at and cancelled, and what is said where it cannot."""

from typing import Any

import pytest
from fastapi.testclient import TestClient

from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.messages.maps import AddNode, Node
from tests.unit.services.map_store.conftest import add, app_of, features

END_S = 30.0


@pytest.fixture
def http(store: MapStore) -> TestClient:
    """A client of the maps "flat" and "house", and of "orbs", which another pipeline made."""
    for name in ("house", "orbs"):
        store.create(name)
    for name in ("flat", "house"):
        store.transact(name, [add(0), add(1)])
    other = Node(node_id=0, pipeline="orb")
    store.transact("orbs", [AddNode(node=other, features=features(0))])
    return TestClient(app_of(store), raise_server_exceptions=False)


@pytest.mark.parametrize(
    ("name", "body", "status", "title", "got"),
    [
        ("flat", {"other": "nowhere"}, 404, "unknown map", "nowhere"),
        ("nowhere", {"other": "flat"}, 404, "unknown map", "nowhere"),
        ("flat", {"other": "flat"}, 422, "same map", "flat twice"),
        ("flat", {"other": ".."}, 422, "invalid request", ".."),
        ("flat", {"other": "orbs"}, 409, "pipelines differ", "orb, sift"),
    ],
)
def test_what_cannot_be_merged_is_a_problem_that_says_what_came(
    http: TestClient, name: str, body: dict[str, Any], status: int, title: str, got: str
):
    answer = http.post(f"/maps/{name}/merge", json=body)
    assert answer.headers["content-type"] == "application/problem+json"
    told = answer.json()
    assert (answer.status_code, told["title"], told["got"]) == (status, title, got)
    assert told["type"] == f"urn:topnav:problem:{title.replace(' ', '_')}"
    assert told["detail"] == f"expected {told['expected']}, got {got}; {told['next']}"


@pytest.mark.parametrize("body", [{}, {"other": 3}, {"other": "house", "more": 1}])
def test_other_bodies_are_refused(http: TestClient, body: dict[str, Any]):
    assert http.post("/maps/flat/merge", json=body).status_code == 422


def test_half_a_surrogate_pair_for_a_name_is_refused_and_told(http: TestClient):
    """JSON can say it and UTF-8 cannot."""
    headers = {"Content-Type": "application/json"}
    answer = http.post("/maps/flat/merge", content=rb'{"other": "\ud800"}', headers=headers)
    assert (answer.status_code, answer.json()["got"]) == (422, "?")


@pytest.mark.parametrize("method", ["GET", "DELETE"])
def test_a_map_that_none_was_merged_into_has_no_merge(http: TestClient, method: str):
    answer = http.request(method, "/maps/house/merge")
    assert (answer.status_code, answer.json()["title"]) == (404, "no merge")


def test_a_merge_is_started_looked_at_and_ends_without_a_feature_service(http: TestClient):
    answer = http.post("/maps/flat/merge", json={"other": "house"})
    assert (answer.status_code, answer.headers["location"]) == (202, "/maps/flat/merge")
    assert answer.json() | {"state": "", "reason": ""} == {
        "map": "flat",
        "other": "house",
        "state": "",
        "matched": 0,
        "nodes": 2,
        "edges": 0,
        "cross_edges": 0,
        "reason": "",
    }
    assert wait_until(lambda: http.get("/maps/flat/merge").json()["state"] == "failed", END_S)
    ended = http.delete("/maps/flat/merge")
    assert (ended.status_code, ended.json()["state"]) == (200, "failed")
    assert ended.json()["reason"] == "no answer of the feature service: nobody answers"
