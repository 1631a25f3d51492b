"""Signs in the console: listed, searched beside the places, driven to in one click, forgotten."""

from pathlib import Path
from typing import Any

from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.messages.places import PutSign, Sighting, Sign
from tests.browser import WAIT_MS, needs_chromium, require_accessible
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner
from tests.integration.gateway.test_places_page import page as page
from tests.integration.gateway.test_places_page import store as store

pytestmark = needs_chromium
NAUGHTY = "<img src=x onerror=alert(1)>"


def read(name: str, *nodes: int) -> PutSign:
    """A sign that was read from some nodes, from the first best."""
    sightings = (Sighting(node=n, bearing_rad=0.5, height_rad=0.03, confidence=0.99) for n in nodes)
    return PutSign(sign=Sign(name=name, sightings=tuple(sightings)))


def test_a_sign_is_found_and_driven_to_in_one_click(page: Any, store: MapStore, planner: Planner) -> None:
    store.transact("flat", [read("room 214", 3, 2), read("room 215", 5), read(NAUGHTY, 1)])
    page.wait_for_selector("#signs tr:has-text('room 214'):has-text('node 3')", timeout=WAIT_MS)
    assert page.inner_text(f"#signs button:text-is('{NAUGHTY}')") == NAUGHTY
    page.fill("#place-search", "215")
    page.wait_for_selector("#signs:not(:has-text('room 214')) td:has-text('room 215')", timeout=WAIT_MS)
    page.click("#signs button:text-is('Go there')")
    assert wait_until(
        lambda: bool(planner.asked) and planner.asked[-1].parameters == {"sign": "room 215"}, WAIT_S
    )
    page.click("#signs button:text-is('room 215')")
    page.wait_for_selector("#inspector-title:text-is('Node 5')", timeout=WAIT_MS)


def test_one_that_was_misread_is_forgotten(page: Any, store: MapStore) -> None:
    store.transact("flat", [read("room 2I4", 3)])
    page.wait_for_selector("#signs td:has-text('room 2I4')", timeout=WAIT_MS)
    page.click("#signs button:text-is('Forget')")
    page.click("#confirm-yes")
    page.wait_for_selector("#signs:not(:has(td))", state="attached", timeout=WAIT_MS)
    assert store.graph("flat")[1].marks.signs == ()


def test_of_hundreds_the_first_are_shown_and_the_view_is_accessible(
    page: Any, store: MapStore, tmp_path: Path
) -> None:
    store.transact("flat", [read(f"room {number}", number % 8) for number in range(100, 130)])
    page.wait_for_selector("#signs:has-text('10 more: search for them.')", timeout=WAIT_MS)
    assert page.locator("#signs td .link").count() == 20
    require_accessible(page, tmp_path)
