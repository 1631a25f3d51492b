"""The emergency stop over HTTP, and what pages hear of it."""

import json
import socket
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime
from pathlib import Path

import httpx
import pytest
from websockets.sync.client import connect

from services.gateway.http.rates import RateLimits
from services.gateway.live.bridge import Bridge
from shared.bus import Bus, wait_until
from shared.estop.sides import EStopServer
from shared.transport.keys import RESERVED
from tests.integration.gateway.gateway_process import WAIT_S, sees
from tests.integration.gateway.standins import Peer

PATH = "/api/robots/e1/estop"
FLOOD = 80


@pytest.fixture(scope="module")
def drive(endpoint: str, gateway: str, patient_stops: None) -> Iterator[None]:  # noqa: ARG001
    """A drive service that only knows the emergency stop, and that the gateway has met."""

    def setup(bus: Bus) -> Callable[[], None]:
        estop = EStopServer(bus, "e1", Path(folder))
        return lambda: estop.step(time.monotonic())

    with tempfile.TemporaryDirectory() as folder, Peer(endpoint, "drive", setup):
        assert wait_until(lambda: sees(gateway, ["drive"]), WAIT_S)
        yield


@pytest.fixture
def clear(http: httpx.Client, drive: None) -> Iterator[httpx.Client]:  # noqa: ARG001
    """A client; the stop is clear before and after."""
    yield http
    assert http.delete(PATH, params={"who": "test"}).status_code == 200


def told(http: httpx.Client) -> bool:
    """Whether the gateway has heard on the bus that the stop is engaged."""
    return bool((http.get("/api/robots/e1").json().get("estop") or {}).get("engaged"))


def test_engage_look_and_clear(clear: httpx.Client) -> None:
    engaged = clear.post(PATH, json={"why": "a child", "who": "anna"})
    assert engaged.status_code == 200
    assert engaged.json() | {"since": None} == {
        "robot": "e1",
        "engaged": True,
        "who": "anna",
        "why": "a child",
        "since": None,
        "warning": "",
    }
    assert clear.get(PATH).json() == engaged.json()
    cleared = clear.request("DELETE", PATH, json={"who": "bert", "why": "looked"})
    assert cleared.status_code == 200
    assert (cleared.json()["engaged"], cleared.json()["who"]) == (False, "bert")
    since = [datetime.fromisoformat(answer.json()["since"]) for answer in (engaged, cleared)]
    assert since[0] < since[1]


def test_a_stop_needs_no_body_and_no_reason_is_too_long_for_it(clear: httpx.Client) -> None:
    assert clear.post(PATH).json()["engaged"]
    clear.delete(PATH, params={"who": "anna"})
    assert clear.post(PATH, json={"why": "x" * 1000}).json()["why"] == "x" * 400


def test_a_final_slash_is_no_redirect(clear: httpx.Client) -> None:
    assert clear.post(f"{PATH}/", follow_redirects=False).json()["engaged"]
    assert clear.get(f"{PATH}/", follow_redirects=False).json()["engaged"]
    gone = clear.delete(f"{PATH}/", params={"who": "anna"}, follow_redirects=False)
    assert not gone.json()["engaged"]


FORM = "application/x-www-form-urlencoded"
ODD_BODIES = [
    pytest.param(b"", FORM, "", "gateway", id="curl -d ''"),
    pytest.param(b'{"who": "anna"}', FORM, "", "anna", id="curl's own content type"),
    pytest.param(b"who=anna", FORM, "body", "gateway", id="a form"),
    pytest.param(b"", "application/json", "", "gateway", id="empty"),
    pytest.param(b'{"reason": "smoke"}', "application/json", "reason", "gateway", id="unknown field"),
    pytest.param(b'{"who": null}', "application/json", "who", "gateway", id="null"),
    pytest.param(b'{"who": "an', "application/json", "body", "gateway", id="cut"),
    pytest.param(b'{"who": "anna\\ud800"}', "application/json", "surrogates", "gateway", id="lone surrogate"),
    pytest.param(b"\xff\xfe", "application/json", "body", "gateway", id="no text"),
    pytest.param(b"[" * 5000, "application/json", "body", "gateway", id="deep"),
    pytest.param(b"x" * 100_000, "text/plain", "bytes", "gateway", id="long"),
]


@pytest.mark.parametrize(("body", "kind", "warned", "who"), ODD_BODIES)
def test_a_stop_holds_whatever_its_body_is_and_says_what_was_wrong(
    clear: httpx.Client, body: bytes, kind: str, warned: str, who: str
) -> None:
    answer = clear.post(PATH, content=body, headers={"Content-Type": kind})
    assert answer.status_code == 200, answer.text
    assert (answer.json()["engaged"], answer.json()["who"]) == (True, who)
    assert warned in answer.json()["warning"]
    assert bool(answer.json()["warning"]) is bool(warned)


def test_a_stop_holds_while_its_body_is_still_on_the_way(clear: httpx.Client, gateway: str) -> None:
    """Nobody waits for a reason: the head says all that it takes."""
    address = httpx.URL(gateway)
    with socket.create_connection((address.host, address.port)) as sender:
        head = f"POST {PATH} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        sender.sendall(f'{head}Content-Length: 100\r\n\r\n{{"who"'.encode())
        assert wait_until(lambda: clear.get(PATH).json()["engaged"], 5.0)


def test_nobody_can_write_what_only_a_token_proves(clear: httpx.Client) -> None:
    assert clear.post(PATH, json={"who": "anna (token anna)"}).json()["who"] == "anna token anna"


@pytest.mark.parametrize("body", [b'{"who": "anna\\ud800"}', b'{"who": "an'])
def test_a_clearance_that_cannot_be_read_clears_nothing(clear: httpx.Client, body: bytes) -> None:
    clear.post(PATH)
    answer = clear.request("DELETE", PATH, content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert clear.get(PATH).json()["engaged"]


@pytest.mark.parametrize("who", [None, "", "  "])
def test_clearing_needs_a_name(clear: httpx.Client, who: str | None) -> None:
    clear.post(PATH)
    answer = clear.delete(PATH, params={} if who is None else {"who": who})
    assert (answer.status_code, answer.json()["title"]) == (422, "who required")
    assert clear.get(PATH).json()["engaged"]


def test_a_robot_nobody_heard_of_is_named(http: httpx.Client) -> None:
    answer = http.post("/api/robots/nobody/estop")
    assert (answer.status_code, answer.json()["got"]) == (404, "nobody")


@pytest.mark.parametrize("method", ["GET", "POST"])
def test_questions_about_robots_that_nobody_heard_of_hold_up_no_stop(
    clear: httpx.Client, gateway: str, method: str
) -> None:
    """Each takes a place for as long as an absent service is waited for."""
    clear.post(PATH)
    assert wait_until(lambda: told(clear), WAIT_S), "this robot was heard of"
    assert clear.delete(PATH, params={"who": "test"}).status_code == 200
    with ThreadPoolExecutor(FLOOD) as pool, httpx.Client(base_url=gateway, timeout=WAIT_S) as other:
        flood = [pool.submit(other.request, method, f"/api/robots/z{n}/estop") for n in range(FLOOD)]
        time.sleep(0.3)
        stopped = clear.post(PATH)
        assert stopped.status_code == 200, stopped.text
        assert not all(one.done() for one in flood), "it waited for none of them"
        assert clear.get(PATH).json()["engaged"]
        assert {one.result().status_code for one in flood} <= {404, 503}


@pytest.mark.parametrize("name", RESERVED)
@pytest.mark.parametrize("method", ["GET", "POST", "DELETE"])
def test_a_name_that_no_robot_may_have_is_refused_with_the_reason(
    http: httpx.Client, method: str, name: str
) -> None:
    answer = http.request(method, f"/api/robots/{name}/estop")
    assert (answer.status_code, answer.json()["title"]) == (422, "invalid request")
    assert f"which begin keys of no robot; got '{name}'" in answer.json()["detail"]


def test_without_drive_it_says_so(http: httpx.Client) -> None:
    """The stand-in knows another robot."""
    answer = http.post("/api/robots/r1/estop")
    assert (answer.status_code, answer.json()["service"]) == (503, "drive")


def test_in_a_flood_of_stops_none_rests_on_what_was_true_before_a_clearance(
    clear: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    deliver = Bridge._deliver

    def late(bridge: Bridge, *news: object) -> bool:
        time.sleep(0.1)
        return deliver(bridge, *news)  # type: ignore[arg-type]

    monkeypatch.setattr(Bridge, "_deliver", late)
    monkeypatch.setattr(RateLimits, "stop", lambda *_: False)
    assert clear.post(PATH).json()["engaged"]
    for _ in range(3):
        assert wait_until(lambda: told(clear), WAIT_S)
        assert not clear.delete(PATH, params={"who": "anna"}).json()["engaged"]
        assert clear.post(PATH).json()["engaged"]
        assert clear.get(PATH).json()["engaged"]


def test_pages_hear_of_it_on_joining_and_on_change(clear: httpx.Client, gateway: str) -> None:
    def heard(socket: object, engaged: bool) -> bool:
        message = json.loads(socket.recv(timeout=WAIT_S))  # type: ignore[attr-defined]
        return message["type"] == "estop" and message["data"]["engaged"] is engaged

    clear.post(PATH, json={"why": "a child"})
    assert wait_until(lambda: told(clear), WAIT_S)
    url = gateway.replace("http", "ws", 1) + "/api/robots/e1/live"
    with connect(url, proxy=None, open_timeout=WAIT_S) as socket:
        assert wait_until(lambda: heard(socket, True), WAIT_S)
        clear.delete(PATH, params={"who": "anna"})
        assert wait_until(lambda: heard(socket, False), WAIT_S)
