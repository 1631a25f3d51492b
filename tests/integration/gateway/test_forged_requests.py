"""Case 20: writes without a token, forged requests of other sites' pages, and WebSockets from elsewhere."""

from collections.abc import Iterator

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.keys import bearer, write_file
from tests.integration.gateway.standins import Planner

START, PAUSE = "/api/robots/r1/missions", "/api/robots/r1/missions/pause"


@pytest.fixture(scope="module")
def guarded(endpoint: str, planner: Planner, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A gateway with tokens that guards reading, too."""
    assert planner
    file = write_file(tmp_path_factory.mktemp("tokens") / "tokens.json")
    yield from serve_gateway(endpoint, ["planner"], tokens_file=file, guard_reading=True)


@pytest.fixture
def page(guarded: str) -> Iterator[httpx.Client]:
    """A browser in which an operator is signed in: it sends the cookie along, whoever makes it ask."""
    with httpx.Client(base_url=guarded, trust_env=False, timeout=WAIT_S) as client:
        assert client.post("/api/session", headers=bearer("operator")).status_code == 200
        yield client


@pytest.mark.parametrize("kind", ["application/x-www-form-urlencoded", "text/plain", "application/json"])
@pytest.mark.parametrize("origin", ["http://evil.example", "null", None])
def test_a_form_of_another_site_starts_nothing(
    page: httpx.Client, planner: Planner, kind: str, origin: str | None
) -> None:
    """Without Origin, as very old browsers send it, the missing token refuses what the session cannot do."""
    asked = len(planner.asked)
    headers = {"Content-Type": kind} | ({"Origin": origin} if origin else {})
    answer = page.post(START, content=b'{"action":"explore","map":"flat"}', headers=headers)
    assert answer.status_code == (403 if origin else 401)
    assert page.post(PAUSE, headers=headers).status_code == answer.status_code
    assert len(planner.asked) == asked


def test_even_a_right_token_does_not_help_another_sites_page(page: httpx.Client) -> None:
    headers = bearer("admin") | {"Origin": "http://evil.example"}
    assert page.post(PAUSE, headers=headers).status_code == 403
    assert page.post("/api/robots/r1/estop", headers={"Origin": "http://evil.example"}).status_code == 403


def test_no_page_elsewhere_may_read_answers(page: httpx.Client) -> None:
    answer = page.get("/api/robots", headers={"Origin": "http://evil.example"})
    assert "access-control-allow-origin" not in answer.headers
    assert answer.headers["cross-origin-resource-policy"] == "same-origin"
    preflight = page.options(
        START, headers={"Origin": "http://evil.example", "Access-Control-Request-Method": "POST"}
    )
    assert preflight.status_code == 405
    assert not [name for name in preflight.headers if name.startswith("access-control")]


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1"])
def test_websockets_of_other_pages_are_refused_though_the_browser_sends_the_cookie(
    page: httpx.Client, guarded: str, origin: str
) -> None:
    cookie = "; ".join(f"{name}={value}" for name, value in page.cookies.items())
    with pytest.raises(InvalidStatus) as caught:
        connect(
            f"{guarded.replace('http', 'ws', 1)}/api/robots/r1/live",
            proxy=None,
            open_timeout=WAIT_S,
            origin=origin,  # type: ignore[arg-type]
            additional_headers={"Cookie": cookie},
        )
    assert caught.value.response.status_code == 403


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8000", "127.0.0.1.evil.example", "r\u00f6bot"]
)
def test_a_name_pointed_at_this_machine_is_refused_for_everything_but_the_empty_page(
    guarded: str, host: str
) -> None:
    headers = [
        (b"host", host.encode("latin-1")),
        (b"authorization", bearer("admin")["Authorization"].encode()),
    ]
    for method, path in (
        ("GET", "/api/robots"),
        ("POST", PAUSE),
        ("GET", "/metrics"),
        ("POST", "/api/session"),
    ):
        answer = httpx.request(method, f"{guarded}{path}", headers=headers, trust_env=False, timeout=WAIT_S)
        assert (answer.status_code, answer.json()["title"]) == (403, "foreign host")


def test_no_page_may_frame_the_console_or_bring_scripts(guarded: str) -> None:
    headers = httpx.get(guarded, trust_env=False, timeout=WAIT_S).headers
    policy = headers["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "no-referrer"
