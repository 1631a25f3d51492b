"""Several robots in the console: all are in one map, and a click follows one."""

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.lifecycle import in_thread
from tests.browser import WAIT_MS, needs_chromium
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Peer, Planner
from tests.integration.gateway.test_places_page import page as page
from tests.integration.gateway.test_places_page import store as store

pytestmark = needs_chromium
DRAWN = """() => Object.fromEntries(document.getElementById('graph')._cyreg.cy.nodes('.robot').map((each) =>
    [each.data('robot'), each.hasClass('followed')]))"""
SPOT = """() => {
    const cy = document.getElementById('graph')._cyreg.cy;
    const at = cy.getElementById('robot-r3').renderedPosition();
    const box = cy.container().getBoundingClientRect();
    return [box.left + at.x, box.top + at.y];
}"""


@pytest.fixture
def fleet(endpoint: str) -> Iterator[None]:
    """Two on their way in the map that the page shows, one in another."""
    where = {"r2": ("flat", 4), "r3": ("flat", 4), "r4": ("yard", 1)}
    robots = [Planner(name) for name in where]

    def tell(stop: threading.Event) -> None:
        while not stop.wait(0.2):
            for robot, (shown, node) in zip(robots, where.values(), strict=True):
                robot.say(mission_id="m", action="goto", map=shown, state="running", nearest_node=node)

    with ExitStack() as there:
        for robot in robots:
            there.enter_context(Peer(endpoint, "planner", robot.setup))
        there.enter_context(in_thread(tell, "fleet"))
        yield


@pytest.mark.usefixtures("fleet")
def test_robots_stand_beside_their_nodes_and_a_click_follows_one(page: Any) -> None:
    page.wait_for_selector('#graph[data-robots="2"]', timeout=WAIT_MS)
    assert page.evaluate(DRAWN).keys() == {"r2", "r3"}
    assert page.inner_text("#robots-text") == "r2 near node 4, r3 near node 4"
    page.mouse.click(*page.evaluate(SPOT))
    assert wait_until(lambda: page.evaluate(DRAWN) == {"r2": False, "r3": True}, WAIT_S)
    assert page.input_value("#robot") == "r3"


def test_of_one_robot_alone_the_nearest_node_is_marked_and_nothing_more(page: Any) -> None:
    page.wait_for_selector('#graph[data-robots="0"]', timeout=WAIT_MS)
    assert page.inner_text("#robots-text") == ""


def test_a_mission_is_meant_for_the_map_that_is_shown_unless_another_was_written(
    page: Any, store: MapStore
) -> None:
    page.wait_for_selector("#map-name option[value=flat]", state="attached", timeout=WAIT_MS)
    assert page.input_value("#new-map") == "flat"
    store.create("yard")
    page.wait_for_selector("#map-name option[value=yard]", state="attached", timeout=WAIT_MS)
    page.select_option("#map-name", "yard")
    assert page.input_value("#new-map") == "yard"
    page.click('nav a[data-view="drive"]')
    page.fill("#new-map", "cellar")
    page.select_option("#map-name", "flat")
    assert page.input_value("#new-map") == "cellar"


def test_parameters_are_called_by_words_with_their_unit(page: Any) -> None:
    page.click('nav a[data-view="drive"]')
    page.wait_for_selector('#mission-kind option[value="explore"]', state="attached", timeout=WAIT_MS)
    page.select_option("#mission-kind", "explore")
    assert page.inner_text("#mission-parameters label").strip() == "Covers (m)"
