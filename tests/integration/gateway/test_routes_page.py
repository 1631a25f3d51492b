"""Teaching and routes in the console: started, finished, listed, drawn and driven, in four clicks at most."""

from pathlib import Path
from typing import Any

from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.messages.maps import DeleteNode
from shared.messages.places import PutRoute, Route
from tests.browser import WAIT_MS, needs_chromium, require_accessible
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner
from tests.integration.gateway.test_places_page import Clicks
from tests.integration.gateway.test_places_page import page as page
from tests.integration.gateway.test_places_page import store as store

pytestmark = needs_chromium
TOUR = Route(name="Tour", nodes=(0, 1, 2, 3))


def asked(planner: Planner, action: str, parameters: dict[str, Any]) -> bool:
    def has_come() -> bool:
        return any(wish.action == action and wish.parameters == parameters for wish in planner.asked)

    return wait_until(has_come, WAIT_S)


def teaching_begun(page: Any) -> Clicks:
    """A route is taught and the robot driven by hand, in the view *Drive*; the clicks that it took."""
    clicks = Clicks(page)
    page.select_option("#mission-kind", "teach")
    clicks.count += 1
    page.fill('#mission-parameters input[name="route"]', "tour")
    clicks.on("#start")
    clicks.on("#by-hand")
    return clicks


def test_teaching_is_started_driven_and_finished_in_four_clicks(page: Any, planner: Planner) -> None:
    page.click('nav a[data-view="drive"]')
    page.wait_for_selector('#mission-kind option[value="teach"]', state="attached", timeout=WAIT_MS)
    assert page.is_hidden("#finish")
    clicks = teaching_begun(page)
    clicks.on("#finish")
    assert asked(planner, "teach", {"route": "tour"})
    assert asked(planner, "finish", {})
    page.wait_for_selector("#finish", state="hidden", timeout=WAIT_MS)
    assert clicks.count == 4


def test_a_mission_that_ends_by_itself_is_not_to_be_finished(page: Any, planner: Planner) -> None:
    page.click('nav a[data-view="drive"]')
    page.wait_for_selector('#mission-kind option[value="explore"]', state="attached", timeout=WAIT_MS)
    page.select_option("#mission-kind", "explore")
    page.click("#start")
    page.wait_for_selector("#cancel:enabled", timeout=WAIT_MS)
    assert page.is_hidden("#finish")
    assert planner.asked[-1].action == "explore"


def test_a_route_is_drawn_when_chosen_and_driven_there_and_back(
    page: Any, store: MapStore, planner: Planner
) -> None:
    store.transact("flat", [PutRoute(route=TOUR)])
    page.wait_for_selector("#routes td:has-text('4 nodes')", timeout=WAIT_MS)
    clicks = Clicks(page)
    clicks.on("#routes button:text-is('Tour')")
    page.wait_for_selector('#graph[data-route="4"]', timeout=WAIT_MS)
    drawn = "document.getElementById('graph')._cyreg.cy.elements('.on-route').map((each) => each.id()).sort()"
    assert page.evaluate(drawn) == ["e0-1", "e1-2", "e2-3", "n0", "n1", "n2", "n3"]
    clicks.on("#routes button:text-is('Back')")
    assert asked(planner, "route", {"route": "Tour", "reverse": True})
    assert clicks.count == 2
    page.click("#routes button:text-is('Tour')")
    page.wait_for_selector('#graph[data-route="0"]', timeout=WAIT_MS)


def test_a_route_whose_node_was_deleted_says_where_it_is_broken_and_is_removed(
    page: Any, store: MapStore
) -> None:
    store.transact("flat", [PutRoute(route=TOUR)])
    store.transact("flat", [DeleteNode(node_id=1)])
    page.wait_for_selector("#routes td:has-text('broken between 0 and 2')", timeout=WAIT_MS)
    page.click("#routes button:text-is('Remove')")
    page.click("#confirm-yes")
    page.wait_for_selector('#graph[data-routes="0"]', timeout=WAIT_MS)
    assert store.graph("flat")[1].marks.routes == ()


def test_the_view_with_routes_is_accessible(page: Any, store: MapStore, tmp_path: Path) -> None:
    store.transact("flat", [PutRoute(route=TOUR), PutRoute(route=Route(name="Round", nodes=(5, 6, 7, 0)))])
    page.wait_for_selector('#graph[data-routes="2"]', timeout=WAIT_MS)
    page.click("#routes button:text-is('Tour')")
    require_accessible(page, tmp_path)
