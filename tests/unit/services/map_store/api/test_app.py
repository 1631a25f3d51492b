"""REST: what each route gives, and a problem for everything that goes wrong."""

import json

import pytest
from fastapi.testclient import TestClient

from services.map_store.api.app import MAX_BODY_BYTES
from services.map_store.errors import InvalidError
from services.map_store.storage import catalogue
from services.map_store.store import MapStore
from tests.unit.services.map_store.conftest import add, app_of, features
from tests.unit.services.map_store.test_store import damage

PROBLEM = "application/problem+json"


def problem(response, status: int) -> str:
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == PROBLEM
    body = response.json()
    assert body["status"] == status
    assert body["type"].startswith("urn:topnav:problem:")
    assert body["title"]
    return str(body["detail"])


def test_maps_are_listed_made_renamed_and_deleted(client: TestClient):
    made = client.post("/maps", json={"name": "house"})
    assert (made.status_code, made.headers["location"]) == (201, "/maps/house")
    assert client.patch("/maps/house", json={"name": "home"}).json()["name"] == "home"
    assert [entry["name"] for entry in client.get("/maps").json()] == ["flat", "home"]
    assert client.delete("/maps/home").status_code == 204
    assert client.get("/maps/flat").json() | {"created_ns": 0, "changed_ns": 0} == {
        "name": "flat",
        "revision": 2,
        "nodes": 3,
        "edges": 2,
        "created_ns": 0,
        "changed_ns": 0,
    }


def test_nodes_are_given_whole_and_by_page(client: TestClient):
    nodes = client.get("/maps/flat/nodes").json()
    assert [node["node_id"] for node in nodes] == [0, 1, 2]
    assert nodes[1]["thumbnail"]
    assert nodes[1]["revision"] == 1
    assert client.get("/maps/flat/nodes", params={"after": 0, "limit": 1}).json() == [nodes[1]]
    assert client.get("/maps/flat/nodes/1").json() == nodes[1]


def test_a_thumbnail_is_the_picture_as_it_was_stored(client: TestClient):
    picture = client.get("/maps/flat/nodes/1/thumbnail")
    assert picture.headers["content-type"] == "image/jpeg"
    assert picture.headers["x-content-type-options"] == "nosniff"
    assert picture.content == features(1).thumbnail


def test_edges_carry_their_evidence_and_revision(client: TestClient):
    edge = client.get("/maps/flat/edges").json()[0]
    assert (edge["a"], edge["b"], edge["raw_matches"], edge["inliers"]) == (0, 1, 60, 40)
    assert (edge["s_min"], edge["s_max"], edge["revision"]) == (30, 60, 2)


def test_deletions_are_revisions_that_undo_takes_back(client: TestClient):
    assert client.delete("/maps/flat/edges/1/0").json() == {"map": "flat", "revision": 3}
    assert client.delete("/maps/flat/nodes/2").json() == {"map": "flat", "revision": 4}
    assert client.get("/maps/flat/edges").json() == []
    assert client.post("/maps/flat/undo").json() == {"map": "flat", "revision": 5, "undone": 4}
    assert client.post("/maps/flat/undo", params={"base_revision": 5}).json()["undone"] == 3
    assert len(client.get("/maps/flat/edges").json()) == 2
    history = client.get("/maps/flat/revisions", params={"limit": 3}).json()
    assert [(entry["revision"], entry["author"], entry["undoes"]) for entry in history] == [
        (6, "rest", 3),
        (5, "rest", 4),
        (4, "rest", None),
    ]


@pytest.mark.parametrize(
    ("method", "path", "status", "text"),
    [
        ("GET", "/maps/house", 404, "no map 'house'; maps: ['flat']"),
        ("GET", "/maps/flat/nodes/9", 404, "node 9 does not exist"),
        ("GET", "/maps/flat/nodes/9/thumbnail", 404, "node 9 does not exist"),
        ("DELETE", "/maps/flat/nodes/9", 404, "node 9 does not exist"),
        ("DELETE", "/maps/flat/edges/0/2", 404, "edge 0-2 does not exist"),
        ("DELETE", "/maps/house", 404, "no map 'house'"),
        ("POST", "/maps/house/undo", 404, "no map 'house'"),
        ("POST", "/maps/flat/undo?base_revision=1", 409, "at revision 2, not 1"),
        ("GET", "/maps/flat/nodes/-1", 422, "node_id"),
        ("GET", f"/maps/flat/nodes/{2**63}", 422, "node_id"),
        ("GET", "/maps/flat/nodes/1.5", 422, "node_id"),
        ("GET", "/maps/flat/nodes?limit=0", 422, "limit"),
        ("GET", "/maps/flat/revisions?limit=100000", 422, "limit"),
        ("GET", "/nowhere", 404, "Not Found"),
        ("PUT", "/maps/flat", 405, "Method Not Allowed"),
    ],
)
def test_what_cannot_be_done_is_a_problem(client: TestClient, method: str, path: str, status: int, text: str):
    assert text in problem(client.request(method, path), status)


@pytest.mark.parametrize(
    "name", ["Flat", "..%5c", "%00", "a%0a", "flat%0a", "%2e%2e", "a%20b", "x" * 65, "%C3%A4", "%ff"]
)
def test_names_outside_the_rule_never_reach_the_store(client: TestClient, name: str):
    for path in (f"/maps/{name}", f"/maps/{name}/nodes", f"/maps/{name}/export"):
        problem(client.get(path), 422)


@pytest.mark.parametrize("name", ["--help", "-", "-x", "import"])
def test_no_map_gets_a_name_that_an_option_or_a_path_has(client: TestClient, store: MapStore, name: str):
    told = problem(client.post("/maps", json={"name": name}), 422)
    assert told.startswith(f"a map's new name must not begin with '-' nor be 'import', got {name!r}")
    assert problem(client.patch("/maps/flat", json={"name": name}), 422) == told
    archive = client.get("/maps/flat/export").content
    assert problem(client.post("/maps/import", params={"name": name}, content=archive), 422) == told
    with pytest.raises(InvalidError, match="must not begin"):
        store.create(name)
    assert [record.name for record in store.summaries()] == ["flat"]


@pytest.mark.parametrize("name", ["--help", "-", "import"])
def test_a_map_of_old_that_has_such_a_name_is_read_exported_and_renamed(
    client: TestClient, store: MapStore, monkeypatch: pytest.MonkeyPatch, name: str
):
    with monkeypatch.context() as before:
        before.setattr(catalogue, "check_new_name", catalogue.check_name)
        store.rename("flat", name)
    assert client.get(f"/maps/{name}").json()["nodes"] == 3
    archive = client.get(f"/maps/{name}/export").content
    assert "choose another" in problem(client.post("/maps/import", content=archive), 422)
    assert client.post("/maps/import", params={"name": "copy"}, content=archive).status_code == 201
    assert store.transact(name, [add(7)]) == 3
    assert client.patch(f"/maps/{name}", json={"name": "house"}).json()["name"] == "house"


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"[]",
        b'{"name": "A"}',
        b'{"name": 1}',
        b'{"name": "x", "more": 1}',
        b'{"name": NaN}',
        b"\xff\xfe",
    ],
)
def test_bad_bodies_are_refused(client: TestClient, body: bytes):
    headers = {"Content-Type": "application/json"}
    assert problem(client.post("/maps", content=body, headers=headers), 422)


def test_creating_or_renaming_to_a_name_in_use_conflicts(client: TestClient):
    assert "exists already" in problem(client.post("/maps", json={"name": "flat"}), 409)
    client.post("/maps", json={"name": "house"})
    assert "exists already" in problem(client.patch("/maps/house", json={"name": "flat"}), 409)


def test_a_body_that_is_too_long_is_refused(client: TestClient):
    body = json.dumps({"name": "x" * MAX_BODY_BYTES})
    headers = {"Content-Type": "application/json"}
    assert "at most 100000 bytes" in problem(client.post("/maps", content=body, headers=headers), 413)
    unannounced = client.post("/maps", content=iter([body.encode()]), headers=headers)
    assert "at most 100000 bytes" in problem(unannounced, 413)


def test_a_node_without_a_picture_says_so(client: TestClient, store: MapStore):
    bare = add(5).model_copy(update={"features": features(5, thumbnail=False)})
    store.transact("flat", [bare])
    assert "no thumbnail" in problem(client.get("/maps/flat/nodes/5/thumbnail"), 404)


def test_damaged_pictures_and_features_are_told(client: TestClient, store: MapStore):
    place = store.graph("flat")[1].nodes[1]
    damage(store.database, place.thumbnail)
    damage(store.database, place.features)
    assert "node 1: thumbnail" in problem(client.get("/maps/flat/nodes/1/thumbnail"), 500)
    store.contents.features("flat", [])
    assert client.get("/maps/flat/nodes/1").json()["quarantined"]
    assert "delete the node" in problem(client.get("/maps/flat/export"), 500)


def test_writes_need_the_token_once_there_is_one_and_reads_do_not(store: MapStore):
    client = TestClient(app_of(store, token="secret"))
    assert client.get("/maps").status_code == 200
    for given in (
        {},
        {"Authorization": "Bearer wrong"},
        {"Authorization": "secret"},
        {"Authorization": "Bearer \xff"},
    ):
        response = client.post(
            "/maps", json={"name": "house"}, headers={k: v.encode("latin-1") for k, v in given.items()}
        )
        problem(response, 401)
        assert response.headers["www-authenticate"] == "Bearer"
    good = {"Authorization": "Bearer secret"}
    assert client.post("/maps", json={"name": "house"}, headers=good).status_code == 201


def test_every_writing_route_is_guarded(store: MapStore):
    client = TestClient(app_of(store, token="secret"))
    paths = client.get("/openapi.json").json()["paths"]
    writes = [
        (m, p) for p, methods in paths.items() for m in methods if m in {"post", "put", "patch", "delete"}
    ]
    assert len(writes) == 17
    for method, path in writes:
        filled = path.format(map="flat", node_id=0, a=0, b=1)
        problem(client.request(method, filled, json={"name": "x"}), 401)


def test_pages_of_another_origin_may_not_write(client: TestClient):
    assert problem(client.post("/maps/flat/undo", headers={"Origin": "https://evil.example"}), 403)
    assert client.post("/maps/flat/undo", headers={"Origin": "http://testserver"}).status_code == 200


def test_readiness_waits_for_the_bus_and_health_does_not(store: MapStore):
    ready = False
    client = TestClient(app_of(store, ready=lambda: ready))
    assert client.get("/healthz").json() == {"status": "alive"}
    problem(client.get("/readyz"), 503)
    ready = True
    assert client.get("/readyz").json() == {"status": "ready"}


def test_a_fault_inside_is_a_problem_without_its_innards(client: TestClient, monkeypatch: pytest.MonkeyPatch):
    def fail(_self: MapStore) -> None:
        raise RuntimeError("secret path")

    monkeypatch.setattr(MapStore, "summaries", fail)
    assert problem(client.get("/maps"), 500) == "the map store failed; its log says why"


def test_openapi_describes_every_route(client: TestClient):
    described = client.get("/openapi.json").json()
    assert len(described["paths"]) == 29
    assert described["paths"]["/maps/import"]["post"]["requestBody"]["content"].keys() == {"application/zip"}
