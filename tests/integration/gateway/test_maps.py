"""Maps through the gateway: paths, bodies, files and problems of the map store unchanged."""

import socket
import threading
from contextlib import suppress

import httpx
import pytest

from tests.integration.gateway.conftest import Stored, serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, answers, free_port


def test_lists_are_passed_back(http: httpx.Client) -> None:
    assert [entry["name"] for entry in http.get("/api/maps").json()] == ["flat"]
    assert len(http.get("/api/maps/flat/nodes").json()) == 5
    assert http.get("/api/maps/flat/edges").json()[1]["suspended"] is True


def test_query_parameters_reach_the_store(http: httpx.Client, stored: Stored) -> None:
    http.get("/api/maps/flat/nodes?after=3&limit=2")
    assert stored[1][-1] == ("GET", "/maps/flat/nodes?after=3&limit=2")


def test_thumbnails_are_pictures(http: httpx.Client) -> None:
    answer = http.get("/api/maps/flat/nodes/2/thumbnail")
    assert (answer.headers["content-type"], answer.content) == ("image/jpeg", b"jpeg")
    assert answer.headers["cache-control"] == "private, no-cache"


def test_an_export_is_a_download(http: httpx.Client) -> None:
    answer = http.get("/api/maps/flat/export")
    assert answer.headers["content-disposition"] == 'attachment; filename="flat.zip"'
    assert len(answer.content) == 3_000_002


def test_an_import_streams_through(http: httpx.Client, stored: Stored) -> None:
    answer = http.post(
        "/api/maps/import?name=copy", content=bytes(5_000_000), headers={"content-type": "application/zip"}
    )
    assert (answer.status_code, answer.json()) == (201, {"bytes": 5_000_000})
    assert stored[1][-1] == ("POST", "/maps/import?name=copy")


def test_rename_delete_and_undo_reach_the_store(http: httpx.Client, stored: Stored) -> None:
    assert http.patch("/api/maps/flat", json={"name": "new"}).json()["sent"] == '{"name":"new"}'
    http.delete("/api/maps/flat")
    http.post("/api/maps/flat/undo")
    assert stored[1][-3:] == [("PATCH", "/maps/flat"), ("DELETE", "/maps/flat"), ("POST", "/maps/flat/undo")]


def test_the_stores_problems_come_unchanged(http: httpx.Client) -> None:
    answer = http.get("/api/maps/other")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["type"] == "urn:topnav:problem:missing"


def test_an_answer_that_is_no_problem_document_becomes_one(http: httpx.Client) -> None:
    answer = http.post("/api/maps/broken/undo")
    assert (answer.status_code, answer.json()["title"]) == (502, "bad answer")


@pytest.mark.parametrize("name", ["A", "..%5cetc", "%00", "a%0a", "%2e%2e", "a b", "x" * 65, "ä"])
def test_names_are_checked_before_they_reach_the_store(http: httpx.Client, stored: Stored, name: str) -> None:
    asked = len(stored[1])
    answer = http.get(f"/api/maps/{name}/nodes")
    assert answer.status_code in (404, 422), answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert len(stored[1]) == asked


@pytest.mark.parametrize("path", ["nodes/{0}", "nodes/{0}/thumbnail", "edges/1/{0}/matches", "edges/{0}/1"])
@pytest.mark.parametrize("number", ["9" * 4400, "9" * 20, "-1", "x", "1.5"])
def test_numbers_of_nodes_are_checked_as_any_input_is(http: httpx.Client, path: str, number: str) -> None:
    """Python refuses to read 4400 digits: raised in a route's own pattern, that was a traceback a request."""
    method = "DELETE" if path == "edges/{0}/1" else "GET"
    answer = http.request(method, "/api/maps/flat/" + path.format(number))
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"


def test_a_store_that_is_down_is_a_missing_service(endpoint: str) -> None:
    for address in serve_gateway(endpoint, map_store_url=f"http://127.0.0.1:{free_port()}"):
        answer = httpx.get(f"{address}/api/maps", trust_env=False, timeout=WAIT_S)
        assert answer.status_code == 503
        assert answer.json()["service"] == "map_store"
        assert answers(address)


class HangsUp(threading.Thread):
    """A map store that ends its first connection as a request comes, and answers on the next ones."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.asked: list[bytes] = []

    def run(self) -> None:
        with suppress(OSError):
            while True:
                with self.listening.accept()[0] as caller:
                    self.asked.append(caller.recv(65536).split(b" ", 1)[0])
                    if len(self.asked) > 1:
                        caller.sendall(b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\nConnection: close\r\n\r\n[]")


@pytest.mark.parametrize(
    ("method", "status", "asked"),
    [
        pytest.param("GET", 200, [b"GET", b"GET"], id="reading is asked again"),
        pytest.param("DELETE", 503, [b"DELETE"], id="changing is not"),
    ],
)
def test_a_connection_that_the_store_ends_as_it_is_asked(
    endpoint: str, method: str, status: int, asked: list[bytes]
) -> None:
    store = HangsUp()
    store.start()
    for address in serve_gateway(
        endpoint, map_store_url=f"http://127.0.0.1:{store.listening.getsockname()[1]}"
    ):
        answer = httpx.request(method, f"{address}/api/maps/flat", trust_env=False, timeout=WAIT_S)
        assert (answer.status_code, store.asked) == (status, asked), answer.text
    store.listening.close()


def test_an_import_beyond_the_limit_is_refused(endpoint: str, stored: Stored) -> None:
    store = f"http://127.0.0.1:{stored[0]}"
    for address in serve_gateway(endpoint, map_store_url=store, max_import_bytes=10_000):
        answer = httpx.post(
            f"{address}/api/maps/import", content=bytes(200_000), trust_env=False, timeout=WAIT_S
        )
        assert (answer.status_code, answer.json()["title"]) == (413, "body too large")
