"""Places and rules in the console: a node named, an area drawn, kept out of; in four clicks at most."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.messages.maps import Edge, PutEdge
from shared.messages.places import KeepOut, Place, PutPlace, PutRule, Slow
from tests.browser import WAIT_MS, listen, needs_chromium, require_accessible
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner, served
from tests.unit.services.map_store.conftest import add, app_of

pytestmark = needs_chromium
COUNT = 8
SPOT = """async (id) => {
    const graph = document.getElementById("graph");
    const spot = () => {
        const box = graph.getBoundingClientRect(), at = graph._cyreg.cy.getElementById(id).renderedPosition();
        return [box.x + at.x, box.y + at.y];
    };
    let at = spot();
    for (let still = 0; still < 10; still++) {
        await new Promise(requestAnimationFrame);
        const now = spot();
        if (now[0] !== at[0] || now[1] !== at[1]) still = 0;
        at = now;
    }
    return at;
}"""
"""Where a node is drawn once it has stayed there for ten pictures of the screen: while the page fills, the
drawing is fitted anew."""


@pytest.fixture
def store(tmp_path: Path) -> Iterator[MapStore]:
    """A real store with one map, a ring of nodes."""
    database = Database(f"sqlite:///{tmp_path}/maps.sqlite3")
    opened = MapStore(database, lambda: 1, lambda _: None)
    opened.create("flat")
    ring = [PutEdge(edge=Edge(a=n, b=n + 1, inliers=60)) for n in range(COUNT - 1)]
    ring.append(PutEdge(edge=Edge(a=0, b=COUNT - 1, inliers=60)))
    opened.transact("flat", [*(add(n) for n in range(COUNT)), *ring])
    yield opened
    database.close()


@pytest.fixture
def page(browser: Any, endpoint: str, store: MapStore, planner: Planner) -> Iterator[Any]:
    """The map view of a gateway before it; at the end nothing may have been wrong with it."""
    assert planner
    with served(app_of(store)) as port:
        for address in serve_gateway(endpoint, ("planner",), map_store_url=f"http://127.0.0.1:{port}"):
            opened, faults = browser.new_page(viewport={"width": 1440, "height": 900}), []
            listen(opened, address, faults)
            opened.goto(f"{address}/#map")
            opened.wait_for_selector(f'#graph[data-nodes="{COUNT}"]', timeout=WAIT_MS)
            yield opened
            opened.close()
            assert [fault for fault in faults if "status of 422" not in fault] == []  # what one test provokes


class Clicks:
    """Clicks and counts them."""

    def __init__(self, page: Any) -> None:
        self.page, self.count = page, 0

    def on(self, selector: str) -> None:
        """Click something."""
        self.count += 1
        self.page.click(selector, timeout=WAIT_MS)

    def on_node(self, number: int) -> None:
        """Click a node of the drawing."""
        self.count += 1
        self.page.mouse.click(*self.page.evaluate(SPOT, f"n{number}"))

    def drag_round(self, *numbers: int) -> None:
        """Drag a frame round some nodes."""
        self.count += 1
        spots = [self.page.evaluate(SPOT, f"n{number}") for number in numbers]
        left, top = (min(spot[axis] for spot in spots) - 25 for axis in (0, 1))
        right, bottom = (max(spot[axis] for spot in spots) + 25 for axis in (0, 1))
        self.page.mouse.move(left, top)
        self.page.mouse.down()
        self.page.mouse.move(right, bottom, steps=4)
        self.page.mouse.up()


def places_of(store: MapStore) -> dict[str, tuple[int, ...]]:
    return {place.name: place.nodes for place in store.graph("flat")[1].marks.places}


def test_a_node_gets_a_name_in_three_clicks_is_found_by_it_and_driven_to(
    page: Any, store: MapStore, planner: Planner
) -> None:
    clicks = Clicks(page)
    clicks.on_node(3)
    clicks.on("#name-node")
    page.fill("#ask-value", "Küche <b>2</b>")
    clicks.on("#ask-yes")
    page.wait_for_selector('#graph[data-places="1"]', timeout=WAIT_MS)
    assert (places_of(store), clicks.count) == ({"Küche <b>2</b>": (3,)}, 3)
    store.transact("flat", [PutPlace(place=Place(name="Dock", nodes=(5,)))])
    page.wait_for_selector('#graph[data-places="2"]', timeout=WAIT_MS)
    page.fill("#place-search", "kuche")
    page.wait_for_selector("#places:not(:has-text('Dock')) td:has-text('Küche <b>2</b>')", timeout=WAIT_MS)
    page.click("#places button:text-is('Go there')")
    wanted = {"place": "Küche <b>2</b>"}
    assert wait_until(lambda: bool(planner.asked) and planner.asked[-1].parameters == wanted, WAIT_S)


def test_an_area_is_drawn_and_named_and_kept_out_of_in_four_clicks_each(page: Any, store: MapStore) -> None:
    clicks = Clicks(page)
    clicks.on("#pick")
    clicks.drag_round(0, 1, 2)
    picked = page.inner_text("#pick")
    clicks.on("#name-picked")
    page.fill("#ask-value", "Lab")
    clicks.on("#ask-yes")
    page.wait_for_selector('#graph[data-places="1"]', timeout=WAIT_MS)
    assert clicks.count == 4
    assert {0, 1, 2} <= set(places_of(store)["Lab"])
    assert picked.startswith(f"{len(places_of(store)['Lab'])} picked")
    again = Clicks(page)
    again.on("#pick")
    again.on_node(6)
    again.on("#forbid-picked")
    page.fill("#ask-value", "no robots")
    again.on("#ask-yes")
    page.wait_for_selector('#graph[data-forbidden="1"]', timeout=WAIT_MS)
    assert again.count == 4
    (rule,) = store.graph("flat")[1].marks.rules
    assert (rule.name, rule.nodes) == ("no robots", (6,))
    page.wait_for_selector("#rules td:has-text('keep out: 6')", timeout=WAIT_MS)
    page.click("#rules button:text-is('Lift')")
    page.click("#confirm-yes")
    page.wait_for_selector('#graph[data-forbidden="0"]', timeout=WAIT_MS)
    assert store.graph("flat")[1].marks.rules == ()


def test_what_the_store_refuses_is_said(page: Any, store: MapStore) -> None:
    page.mouse.click(*page.evaluate(SPOT, "n3"))
    page.click("#name-node")
    page.fill("#ask-value", "a\u202eb")
    page.click("#ask-yes")
    page.wait_for_selector("#said:has-text('invisible')", timeout=WAIT_MS)
    assert places_of(store) == {}


def test_the_view_with_places_and_rules_is_accessible(page: Any, store: MapStore, tmp_path: Path) -> None:
    places = [
        Place(name="Kitchen", nodes=(3,)),
        Place(name="Meeting rooms of the second floor", nodes=(0, 1)),
    ]
    slow = Slow(name="wet floor", edges=((4, 5),), speed_share=0.3)
    shut = KeepOut(name="no robots", nodes=(6,), areas=("Kitchen",))
    rules = [PutRule(rule=rule) for rule in (slow, shut)]
    store.transact("flat", [*(PutPlace(place=place) for place in places), *rules])
    page.wait_for_selector('#graph[data-places="2"]', timeout=WAIT_MS)
    assert page.get_attribute("#graph", "data-forbidden") == "2"
    page.wait_for_selector("#rules td:has-text('30 % of the speed')", timeout=WAIT_MS)
    require_accessible(page, tmp_path)
