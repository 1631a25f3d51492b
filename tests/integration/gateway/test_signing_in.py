"""The console asks for a token, reads with it, follows live, and says what a role may not do."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from shared.bus import wait_until
from tests.browser import WAIT_MS, needs_chromium
from tests.integration.gateway.conftest import Stored, serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.keys import SECRETS, write_file
from tests.integration.gateway.standins import Planner

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = needs_chromium


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A token file."""
    return write_file(tmp_path_factory.mktemp("tokens") / "tokens.json")


@pytest.fixture(scope="module")
def guarded(endpoint: str, planner: Planner, stored: Stored, file: Path) -> Iterator[str]:
    """A gateway that asks for tokens, to read as well."""
    assert planner
    store = f"http://127.0.0.1:{stored[0]}"
    settings = {"tokens_file": file, "guard_reading": True, "map_store_url": store}
    yield from serve_gateway(endpoint, ["planner"], **settings)


@pytest.fixture
def page(browser: "Browser", guarded: str) -> Iterator["Page"]:
    """The console in a browser of its own."""
    context = browser.new_context()
    opened = context.new_page()
    opened.goto(guarded)
    yield opened
    context.close()


def sign_in(page: "Page", secret: str) -> None:
    page.wait_for_selector("#token-dialog[open]", timeout=WAIT_MS)
    page.fill("#token", secret)
    page.click("#token-dialog button.primary")


def explore(page: "Page") -> None:
    page.wait_for_selector("#start:enabled", timeout=WAIT_MS)
    page.select_option("#mission-kind", "explore")
    page.click("#start")


def test_a_viewer_sees_everything_and_is_told_what_takes_more(page: "Page", planner: Planner) -> None:
    addresses: list[str] = []
    page.on("request", lambda request: addresses.append(request.url))
    page.on("websocket", lambda live: addresses.append(live.url))
    sign_in(page, SECRETS["viewer"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    page.wait_for_selector('#graph[data-nodes="5"]', timeout=WAIT_MS)
    page.wait_for_selector("#identity:text-is('vera, viewer')", timeout=WAIT_MS)
    asked = len(planner.asked)
    explore(page)
    page.wait_for_selector("#answer.bad", timeout=WAIT_MS)
    assert (
        page.inner_text("#answer")
        == "Not with this token: it takes role agent, yours is viewer (token vera)."
    )
    assert len(planner.asked) == asked
    assert not [address for address in addresses if "secret" in address]
    assert "secret" not in page.evaluate("document.cookie")
    assert page.evaluate("localStorage.length") == 0


def test_pictures_load_though_they_carry_no_header(page: "Page") -> None:
    sign_in(page, SECRETS["viewer"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    assert page.evaluate("fetch('/api/maps/flat/nodes/1/thumbnail').then((answer) => answer.status)") == 200


def test_an_operator_steers_after_a_reload_without_being_asked_again(page: "Page", planner: Planner) -> None:
    sign_in(page, SECRETS["operator"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    page.reload()
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    assert not page.is_visible("#token-dialog")
    page.wait_for_selector("#identity:text-is('otto, operator')", timeout=WAIT_MS)
    before = len(planner.asked)
    explore(page)
    assert wait_until(lambda: any(wish.action == "explore" for wish in planner.asked[before:]), WAIT_S)


def test_a_wrong_token_is_said_and_asked_for_again(page: "Page") -> None:
    sign_in(page, "no such secret")
    page.wait_for_selector("#token-said:not(:empty)", timeout=WAIT_MS)
    assert "does not take this token" in page.inner_text("#token-said")
    sign_in(page, SECRETS["viewer"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)


def test_who_declines_is_not_asked_again_and_again_and_can_come_back(page: "Page") -> None:
    page.wait_for_selector("#token-dialog[open]", timeout=WAIT_MS)
    page.click("#token-dialog button:text-is('Not now')")
    page.wait_for_selector("#notice:has-text('nothing without a token')", timeout=WAIT_MS)
    page.wait_for_timeout(6000)  # longer than the page waits before it asks the gateway by itself
    assert not page.is_visible("#token-dialog")
    page.click("#identity")
    sign_in(page, SECRETS["viewer"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)


def test_a_removed_token_shows_nothing_any_more(page: "Page", file: Path) -> None:
    sign_in(page, SECRETS["viewer"])
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    try:
        write_file(file, without="viewer")
        page.wait_for_selector("#token-said:has-text('does not take this token')", timeout=WAIT_MS)
        page.wait_for_selector("#notice:has-text('nothing without a token')", timeout=WAIT_MS)
    finally:
        write_file(file)
