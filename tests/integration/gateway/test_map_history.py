"""What the map store knows of a map's past, through the gateway: the real store behind it."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.maps import Edge, PutEdge
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import served
from tests.unit.services.map_store.conftest import add, app_of

ANNA = {"X-Topnav-Author": "anna"}


@pytest.fixture
def http(endpoint: str, tmp_path: Path) -> Iterator[httpx.Client]:
    """A client of a gateway before a map store with one map of two places."""
    database = Database(f"sqlite:///{tmp_path}/maps.sqlite3")
    store = MapStore(database, lambda: 1, lambda _: None)
    store.create("flat")
    store.transact("flat", [add(0), add(1)], author="planner")
    store.transact("flat", [PutEdge(edge=Edge(a=0, b=1, inliers=40))], author="planner")
    with served(app_of(store)) as port:
        for address in serve_gateway(endpoint, map_store_url=f"http://127.0.0.1:{port}"):
            with httpx.Client(base_url=address, trust_env=False, timeout=WAIT_S) as client:
                yield client
    database.close()


def test_keypoints_of_a_place_are_passed_back(http: httpx.Client) -> None:
    given = http.get("/api/maps/flat/nodes/1/keypoints").json()
    assert (len(given["lonlat_rad"]), len(given["lonlat_rad"][0]), len(given["scores"])) == (4, 2, 4)
    missing = http.get("/api/maps/flat/nodes/9/keypoints")
    assert (missing.status_code, missing.headers["content-type"]) == (404, "application/problem+json")
    assert "node 9 does not exist" in missing.json()["detail"]


def test_comparisons_are_of_the_revisions_that_were_asked_for(http: httpx.Client) -> None:
    http.delete("/api/maps/flat/nodes/1")
    newest = http.get("/api/maps/flat/compare?from=1").json()
    assert (newest["from"], newest["to"], newest["nodes_removed"], newest["edges_added"]) == (1, 3, [1], [])
    older = http.get("/api/maps/flat/compare", params={"from": 2, "to": 0}).json()
    assert (older["from"], older["to"], older["nodes_removed"], older["edges_removed"]) == (
        2,
        0,
        [0, 1],
        [[0, 1]],
    )
    missing = http.get("/api/maps/flat/compare?from=1&to=8")
    assert (missing.status_code, missing.json()["type"]) == (404, "urn:topnav:problem:missing")
    assert "revisions: 0 to 3" in missing.json()["detail"]


@pytest.mark.parametrize("sent", [b"\xff", "\u00e4".encode()])
def test_headers_that_are_not_ascii_are_the_map_stores_to_refuse(http: httpx.Client, sent: bytes) -> None:
    answer = http.post("/api/maps/flat/undo", headers=[(b"x-topnav-author", sent)])
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert "X-Topnav-Author" in answer.json()["detail"]
    for name in (b"accept", b"if-match", b"if-none-match"):
        assert http.get("/api/maps/flat", headers=[(name, sent)]).status_code == 200


def test_the_author_of_a_write_reaches_the_history(http: httpx.Client) -> None:
    archive = http.get("/api/maps/flat/export").content
    http.delete("/api/maps/flat/edges/0/1", headers=ANNA)
    http.delete("/api/maps/flat/nodes/1", headers=ANNA)
    http.post("/api/maps/flat/undo", headers=ANNA)
    http.post("/api/maps/flat/undo")
    listed = http.get("/api/maps/flat/revisions").json()
    assert [entry["author"] for entry in listed] == ["rest", "anna", "anna", "anna", "planner", "planner"]
    assert listed[2]["summary"] == "node 1 deleted"
    assert http.post("/api/maps/import?name=copy", content=archive, headers=ANNA).status_code == 201
    assert http.get("/api/maps/copy/revisions").json()[0]["author"] == "anna"


def test_an_author_outside_the_rule_is_the_stores_problem(http: httpx.Client) -> None:
    answer = http.post("/api/maps/flat/undo", headers={"X-Topnav-Author": "Anna B"})
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert "X-Topnav-Author" in answer.json()["detail"]
    assert http.get("/api/maps/flat").json()["revision"] == 2
