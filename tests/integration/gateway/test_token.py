"""The token guards what changes something; reading stays free. Pages of other sites change nothing."""

from collections.abc import Iterator

import httpx
import pytest

from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner

TOKEN = "s3cret"


@pytest.fixture(scope="module")
def guarded(endpoint: str, planner: Planner) -> Iterator[str]:
    """A gateway with a token."""
    assert planner
    yield from serve_gateway(endpoint, ["planner"], token=TOKEN)


def ask(address: str, method: str, path: str, **headers: str) -> httpx.Response:
    return httpx.request(method, f"{address}{path}", headers=headers, trust_env=False, timeout=WAIT_S)


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("POST", "/api/robots/r1/missions"),
        ("POST", "/api/robots/r1/missions/goto?map=flat"),
        ("POST", "/api/robots/r1/missions/cancel"),
        ("DELETE", "/api/robots/r1/estop?who=anna"),
        ("POST", "/api/robots/r1/goal-check?map=flat"),
        ("POST", "/api/maps"),
        ("POST", "/api/session"),
        ("DELETE", "/api/session"),
        ("POST", "/api/maps/import"),
        ("POST", "/api/maps/flat/undo"),
        ("POST", "/api/maps/flat/merge"),
        ("DELETE", "/api/maps/flat/merge"),
        ("PATCH", "/api/maps/flat"),
        ("DELETE", "/api/maps/flat"),
        ("DELETE", "/api/maps/flat/nodes/1"),
        ("DELETE", "/api/maps/flat/edges/1/2"),
    ],
)
@pytest.mark.parametrize("authorization", ["", "Bearer wrong", f"Basic {TOKEN}", "Bearer", "Bearer ä"])
def test_writes_without_the_token_are_refused(
    guarded: str, method: str, path: str, authorization: str
) -> None:
    headers = {"authorization": authorization.encode("latin-1")} if authorization else {}
    url = f"{guarded}{path}"
    answer = httpx.request(method, url, headers=headers, trust_env=False, timeout=WAIT_S)  # type: ignore[arg-type]
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"


def test_the_token_opens_writes(guarded: str) -> None:
    answer = ask(guarded, "POST", "/api/robots/r1/missions/pause", authorization=f"Bearer {TOKEN}")
    assert answer.status_code == 200, answer.text


@pytest.mark.parametrize("path", ["/healthz", "/metrics", "/api/robots", "/api/robots/r1/mission", "/"])
def test_reading_needs_none(guarded: str, path: str) -> None:
    assert ask(guarded, "GET", path).status_code == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null"])
def test_pages_of_other_sites_cannot_steer(http: httpx.Client, planner: Planner, origin: str) -> None:
    asked = len(planner.asked)
    answer = http.post("/api/robots/r1/missions/pause", headers={"origin": origin})
    assert (answer.status_code, answer.json()["title"]) == (403, "foreign origin")
    assert len(planner.asked) == asked


def test_a_name_that_was_pointed_here_is_refused(http: httpx.Client) -> None:
    answer = http.get("/api/robots", headers={"host": "evil.example"})
    assert (answer.status_code, answer.json()["title"]) == (403, "foreign host")
