"""Roles over real sockets: who may read, move robots, change maps; sessions, authors, what a removal ends."""

import contextlib
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from shared.bus import Bus, wait_until
from shared.estop.sides import EStopServer
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, sees
from tests.integration.gateway.keys import NAMES, bearer, write_file
from tests.integration.gateway.standins import Peer, Planner, served

ROBOT = "k1"
ESTOP = f"/api/robots/{ROBOT}/estop"


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A token file."""
    return write_file(tmp_path_factory.mktemp("tokens") / "tokens.json")


@pytest.fixture(scope="module")
def authors() -> Iterator[tuple[str, list[str]]]:
    """A map store that notes who writes: its address and the authors."""
    app, seen = FastAPI(), []

    @app.api_route("/{path:path}", methods=["GET", "POST", "PATCH", "DELETE"])
    async def answer(request: Request) -> Response:
        await request.body()
        seen.append(request.headers.get("x-topnav-author", ""))
        return JSONResponse([])

    with served(app) as port:
        yield f"http://127.0.0.1:{port}", seen


@pytest.fixture(scope="module")
def drive(
    endpoint: str,
    guarded: str,
    patient_stops: None,  # noqa: ARG001
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[None]:
    """A drive service that only knows the emergency stop, and that the gateway has met."""
    folder = tmp_path_factory.mktemp("drive")

    def setup(bus: Bus) -> Callable[[], None]:
        estop = EStopServer(bus, ROBOT, folder)
        return lambda: estop.step(time.monotonic())

    with Peer(endpoint, "drive", setup):
        assert wait_until(lambda: sees(guarded, ["drive"]), WAIT_S)
        yield


@pytest.fixture(scope="module")
def guarded(endpoint: str, planner: Planner, authors: tuple[str, list[str]], file: Path) -> Iterator[str]:
    """A gateway that asks for tokens, to read as well, as it does off loopback."""
    assert planner
    settings = {"tokens_file": file, "guard_reading": True, "map_store_url": authors[0]}
    yield from serve_gateway(endpoint, ["planner"], **settings)


def ask(address: str, role: str | None, method: str, path: str, **options: object) -> httpx.Response:
    headers = {**bearer(role), **options.pop("headers", {})}  # type: ignore[dict-item]
    wish = {"headers": headers, "trust_env": False, "timeout": WAIT_S, **options}
    return httpx.request(method, f"{address}{path}", **wish)  # type: ignore[arg-type]


def follow(address: str, robot: str = ROBOT, **headers: str) -> ClientConnection:
    url = f"{address.replace('http', 'ws', 1)}/api/robots/{robot}/live"
    return connect(url, proxy=None, open_timeout=WAIT_S, additional_headers=headers)


@pytest.mark.parametrize(
    ("method", "path", "least"),
    [
        ("GET", "/api/robots", "viewer"),
        ("GET", "/api/maps", "viewer"),
        ("GET", "/metrics", "viewer"),
        ("POST", "/api/session", "viewer"),
        ("POST", "/api/robots/r1/missions/pause", "agent"),
        ("POST", "/api/maps", "operator"),
        ("POST", "/api/maps/flat/undo", "admin"),
        ("PATCH", "/api/maps/flat", "admin"),
        ("DELETE", "/api/maps/flat", "admin"),
        ("DELETE", "/api/maps/flat/nodes/1", "admin"),
        ("POST", "/api/maps/import", "admin"),
    ],
)
def test_each_role_gets_as_far_as_it_may(guarded: str, method: str, path: str, least: str) -> None:
    ranks = ["viewer", "agent", "operator", "admin"]
    unknown = ask(guarded, None, method, path)
    assert (unknown.status_code, unknown.headers["www-authenticate"]) == (401, "Bearer")
    for role in ranks:
        answer = ask(guarded, role, method, path)
        if ranks.index(role) >= ranks.index(least):
            assert answer.status_code < 300, answer.text
        else:
            assert answer.status_code == 403
            assert answer.json() | {"needed": least, "role": role} == answer.json()


@pytest.mark.parametrize("path", ["/healthz", "/", "/static/main.js", "/openapi.json"])
def test_what_tells_nothing_needs_no_token(guarded: str, path: str) -> None:
    assert ask(guarded, None, "GET", path).status_code == 200


def test_anybody_stops_the_robot_and_an_operator_lets_it_go(guarded: str, drive: None) -> None:  # noqa: ARG001
    assert ask(guarded, None, "POST", ESTOP).json()["engaged"]
    wrong = {"Authorization": "Bearer wrong"}
    assert ask(guarded, None, "POST", ESTOP, headers=wrong).status_code == 200
    assert ask(guarded, None, "DELETE", f"{ESTOP}?who=anna").status_code == 401
    for role in ("viewer", "agent"):
        assert ask(guarded, role, "DELETE", f"{ESTOP}?who=anna").status_code == 403
    cleared = ask(guarded, "operator", "DELETE", f"{ESTOP}?who=anna")
    assert (cleared.json()["engaged"], cleared.json()["who"]) == (False, "anna (token otto)")
    assert ask(guarded, "viewer", "POST", ESTOP, json={"who": "vera"}).json()["who"] == "vera"
    assert ask(guarded, "admin", "DELETE", f"{ESTOP}?who=ada").json()["who"] == "ada"


def test_a_flood_of_stops_is_answered_and_stops_nobody_else(guarded: str, drive: None) -> None:  # noqa: ARG001
    with httpx.Client(base_url=guarded, trust_env=False, timeout=WAIT_S) as client:
        for _ in range(200):
            answer = client.post(ESTOP)
            assert (answer.status_code, answer.json()["engaged"]) == (200, True)
    assert not ask(guarded, "operator", "DELETE", f"{ESTOP}?who=anna").json()["engaged"]
    assert ask(guarded, None, "POST", ESTOP).json()["engaged"]
    assert not ask(guarded, "operator", "DELETE", f"{ESTOP}?who=anna").json()["engaged"]


def test_a_map_is_changed_in_the_tokens_name(guarded: str, authors: tuple[str, list[str]]) -> None:
    ask(guarded, "admin", "DELETE", "/api/maps/flat", headers={"X-Topnav-Author": "planner"})
    assert authors[1][-1] == NAMES["admin"]


def test_a_session_opens_reading_and_nothing_else(guarded: str) -> None:
    with httpx.Client(base_url=guarded, trust_env=False, timeout=WAIT_S) as page:
        opened = page.post("/api/session", headers=bearer("admin"))
        assert opened.json() == {"guarded": True, "name": "ada", "role": "admin", "pass_s": 43200.0}
        cookie = opened.headers["set-cookie"].lower()
        assert "httponly" in cookie
        assert "samesite=strict" in cookie
        assert "secret of" not in cookie
        assert page.get("/api/robots").status_code == 200
        assert page.get("/api/session").json()["name"] == "ada"
        for method, path in (("POST", "/api/robots/r1/missions/pause"), ("DELETE", "/api/maps/flat")):
            assert page.request(method, path).status_code == 401
        page.delete("/api/session", headers=bearer("admin"))
        assert page.get("/api/robots").status_code == 401


def test_a_websocket_wants_a_token_in_its_header_or_a_session(guarded: str) -> None:
    for headers in ({}, {"Authorization": "Bearer wrong"}, {"Cookie": "topnav_pass=x"}):
        with pytest.raises(InvalidStatus) as caught:
            follow(guarded, **headers)
        assert caught.value.response.status_code == 401
        assert json.loads(caught.value.response.body)["title"] == "token required"
    with follow(guarded, **bearer("viewer")) as live:
        assert live.recv(timeout=WAIT_S)
    session = ask(guarded, "viewer", "POST", "/api/session").headers["set-cookie"].partition(";")[0]
    with follow(guarded, Cookie=session, Origin=guarded) as live:
        assert live.recv(timeout=WAIT_S)
    with pytest.raises(InvalidStatus) as caught:
        follow(guarded, Cookie=session, Origin="http://evil.example")
    assert caught.value.response.status_code == 403


def test_a_removed_token_ends_what_it_opened(endpoint: str, tmp_path: Path) -> None:
    file = write_file(tmp_path / "tokens.json")
    running = serve_gateway(endpoint, tokens_file=file, guard_reading=True)
    address = next(running)
    with (
        httpx.Client(base_url=address, trust_env=False, timeout=WAIT_S) as page,
        follow(address, **bearer("viewer")) as live,
    ):
        assert page.post("/api/session", headers=bearer("viewer")).status_code == 200
        assert live.recv(timeout=WAIT_S)
        write_file(file, without="viewer")
        with contextlib.suppress(ConnectionClosed):
            deadline_s = time.monotonic() + WAIT_S
            while time.monotonic() < deadline_s:
                live.recv(timeout=WAIT_S)
        assert (live.close_code, live.close_reason) == (1008, "token_removed")
        assert wait_until(lambda: page.get("/api/robots").status_code == 401, WAIT_S)
        assert ask(address, "viewer", "GET", "/api/robots").status_code == 401
        assert ask(address, "operator", "GET", "/api/robots").status_code == 200
    assert next(running, None) is None


def test_an_operator_drives_by_hand_and_no_viewer_or_agent_does(guarded: str) -> None:
    wish = {"json": {"who": "anna"}}
    for role in ("viewer", "agent"):
        assert ask(guarded, role, "POST", "/api/robots/r1/drive", **wish).status_code == 403
    driven = ask(guarded, "operator", "POST", "/api/robots/r1/drive", **wish)
    assert (driven.status_code, driven.json()["who"]) == (202, "anna (token otto)")
