"""REST on what was done to a map: keypoints of its nodes, comparisons, authors, summaries."""

import numpy as np
import pytest
from fastapi.testclient import TestClient

from services.map_store.store import MapStore
from shared.messages.maps import Edge, PutEdge
from tests.unit.services.map_store.api.test_app import problem
from tests.unit.services.map_store.conftest import Told, add, app_of, features
from tests.unit.services.map_store.test_store import damage

ANNA = {"X-Topnav-Author": "anna"}


def test_keypoints_are_the_stored_ones_in_their_order(client: TestClient):
    given = client.get("/maps/flat/nodes/1/keypoints").json()
    assert given.keys() == {"lonlat_rad", "scores"}
    np.testing.assert_array_equal(np.float32(given["lonlat_rad"]), features(1).lonlat_rad)
    np.testing.assert_array_equal(np.float32(given["scores"]), features(1).scores)


def test_a_node_without_keypoints_gives_empty_lists(client: TestClient, store: MapStore):
    empty = {"lonlat_rad": np.zeros((0, 2), np.float32), "scores": np.zeros(0, np.float32)}
    bare = features(5).model_copy(update=empty | {"descriptors": np.zeros((0, 8), np.float32)})
    store.transact("flat", [add(5).model_copy(update={"features": bare})])
    assert client.get("/maps/flat/nodes/5/keypoints").json() == {"lonlat_rad": [], "scores": []}


def test_damaged_keypoints_are_a_problem_and_noted_at_the_node(client: TestClient, store: MapStore):
    damage(store.database, store.graph("flat")[1].nodes[1].features)
    for _ in range(2):
        told = problem(client.get("/maps/flat/nodes/1/keypoints"), 500)
        assert "map 'flat', node 1: features: damaged; delete the node" in told
    assert client.get("/maps/flat/nodes/1").json()["quarantined"]
    assert client.get("/maps/flat/nodes/2/keypoints").status_code == 200


def test_a_comparison_tells_what_changed_between_two_revisions(client: TestClient, store: MapStore):
    store.transact("flat", [PutEdge(edge=Edge(a=1, b=2, raw_matches=60, inliers=9, s_min=30, s_max=60))])
    client.delete("/maps/flat/nodes/0")
    assert client.get("/maps/flat/compare?from=1").json() == {
        "map": "flat",
        "from": 1,
        "to": 4,
        "nodes_added": [],
        "nodes_removed": [0],
        "nodes_changed": [],
        "edges_added": [[1, 2]],
        "edges_removed": [],
        "edges_changed": [],
        "places_added": [],
        "places_removed": [],
        "places_changed": [],
        "rules_added": [],
        "rules_removed": [],
        "rules_changed": [],
        "routes_added": [],
        "routes_removed": [],
        "routes_changed": [],
        "signs_added": [],
        "signs_removed": [],
        "signs_changed": [],
    }
    back = client.get("/maps/flat/compare?from=4&to=2").json()
    assert (back["from"], back["to"]) == (4, 2)
    assert (back["nodes_added"], back["edges_added"]) == ([0], [[0, 1]])
    assert back["edges_changed"] == [{"a": 1, "b": 2, "before": {"inliers": 9}, "after": {"inliers": 40}}]


def test_values_of_edges_keep_their_kind(client: TestClient, store: MapStore):
    changed = Edge(
        a=0,
        b=1,
        raw_matches=60,
        inliers=40,
        s_min=30,
        s_max=60,
        confidence=1.0,
        heading_ab_rad=0.5,
        suspended=True,
        traversals=1,
        why="x",
    )
    store.transact("flat", [PutEdge(edge=changed)])
    (change,) = client.get("/maps/flat/compare?from=2").json()["edges_changed"]
    assert repr(change["before"]) == repr(
        {"confidence": 0.0, "heading_ab_rad": None, "traversals": 0, "suspended": False, "why": ""}
    )
    assert repr(change["after"]) == repr(
        {"confidence": 1.0, "heading_ab_rad": 0.5, "traversals": 1, "suspended": True, "why": "x"}
    )


@pytest.mark.parametrize(
    ("path", "status", "text"),
    [
        ("/maps/flat/nodes/9/keypoints", 404, "map 'flat': node 9 does not exist"),
        ("/maps/house/nodes/0/keypoints", 404, "no map 'house'; maps: ['flat']"),
        (f"/maps/flat/nodes/{2**63}/keypoints", 422, "node_id"),
        ("/maps/house/compare?from=0", 404, "no map 'house'; maps: ['flat']"),
        ("/maps/flat/compare?from=3", 404, "revision 3 does not exist; revisions: 0 to 2"),
        ("/maps/flat/compare?from=0&to=7", 404, "revision 7 does not exist; revisions: 0 to 2"),
        ("/maps/flat/compare", 422, "query.from"),
        ("/maps/flat/compare?from=-1", 422, "query.from"),
        ("/maps/flat/compare?from=x", 422, "query.from"),
        (f"/maps/flat/compare?from=0&to={2**63}", 422, "query.to"),
    ],
)
def test_what_is_not_there_is_a_problem_that_names_it(client: TestClient, path: str, status: int, text: str):
    assert text in problem(client.get(path), status)


def newest(client: TestClient, name: str = "flat") -> dict:
    return client.get(f"/maps/{name}/revisions", params={"limit": 1}).json()[0]


@pytest.mark.parametrize(("headers", "author"), [(ANNA, "anna"), ({}, "rest")])
def test_every_write_that_makes_a_revision_records_its_author(
    client: TestClient, told: Told, headers: dict[str, str], author: str
):
    archive = client.get("/maps/flat/export").content
    for method, path in (
        ("DELETE", "/maps/flat/edges/0/1"),
        ("DELETE", "/maps/flat/nodes/2"),
        ("POST", "/maps/flat/undo"),
    ):
        assert client.request(method, path, headers=headers).status_code == 200
        assert newest(client)["author"] == author
        assert told[-1].author == author
    zipped = {"Content-Type": "application/zip"} | headers
    assert client.post("/maps/import?name=copy", content=archive, headers=zipped).status_code == 201
    assert newest(client, "copy")["author"] == author


@pytest.mark.parametrize("author", ["a", "x" * 32, "anna.b-c_9"])
def test_authors_within_the_rule_are_taken(client: TestClient, author: str):
    client.delete("/maps/flat/nodes/2", headers={"X-Topnav-Author": author})
    assert newest(client)["author"] == author


@pytest.mark.parametrize("author", ["", "Anna", "a b", "x" * 33, "a/b", "ä", "a,b", "planner"])
@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("DELETE", "/maps/flat/nodes/2"),
        ("DELETE", "/maps/flat/edges/0/1"),
        ("POST", "/maps/flat/undo"),
        ("POST", "/maps/import"),
    ],
)
def test_other_authors_are_refused_and_nothing_is_written(
    client: TestClient, method: str, path: str, author: str
):
    headers = {"X-Topnav-Author": author.encode("latin-1")}
    assert "header.X-Topnav-Author" in problem(client.request(method, path, headers=headers), 422)
    assert client.get("/maps/flat").json()["revision"] == 2


def test_an_author_does_not_replace_the_token(store: MapStore):
    client = TestClient(app_of(store, token="secret"))
    problem(client.post("/maps/flat/undo", headers=ANNA), 401)


def test_the_history_says_what_each_revision_did(client: TestClient):
    client.delete("/maps/flat/nodes/1")
    listed = client.get("/maps/flat/revisions").json()
    assert [entry["summary"] for entry in listed] == [
        "node 1 deleted with 2 edges",
        "2 edges put",
        "3 nodes added",
    ]


def test_the_header_and_both_revisions_are_described(client: TestClient):
    paths = client.get("/openapi.json").json()["paths"]
    for path, method in (
        ("/maps/{map}/undo", "post"),
        ("/maps/import", "post"),
        ("/maps/{map}/nodes/{node_id}", "delete"),
        ("/maps/{map}/edges/{a}/{b}", "delete"),
    ):
        assert "X-Topnav-Author" in {each["name"] for each in paths[path][method]["parameters"]}
    compared = paths["/maps/{map}/compare"]["get"]
    assert {each["name"]: each["required"] for each in compared["parameters"]} == {
        "map": True,
        "from": True,
        "to": False,
    }
    assert compared["responses"].keys() == {"200", "4XX", "5XX"}
