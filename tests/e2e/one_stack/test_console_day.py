"""A day at the console, on real processes: names, a forbidden area, a taught route, a round, its report."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import httpx
import networkx as nx
import pytest

from shared.bus import wait_until
from tests.browser import WAIT_MS, inaccessible, needs_chromium
from tests.e2e.fleet import dispatch_of_the_first
from tests.e2e.one_stack.conftest import WAIT_S, Explored
from tests.e2e.one_stack.test_console import copy_of_map as copy_of_map
from tests.e2e.one_stack.test_console import page as page
from tests.integration.gateway.test_places_page import SPOT, Clicks
from tests.integration.gateway.test_routes_page import teaching_begun

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900), needs_chromium]

ROUND_MS = 300_000
NAMES = ("Dock", "Desk", "Door")
MOST_CLICKS = 4


@pytest.fixture
def http(http: httpx.Client, explored: Explored) -> Iterator[httpx.Client]:
    """Afterwards nothing is scheduled."""
    yield http
    http.delete(f"/api/robots/{explored.stack.robot}/schedules/night")


def test_names_an_area_a_route_and_a_scheduled_round_with_its_report(
    copy_of_map: str, page: Any, http: httpx.Client, explored: Explored, tmp_path: Path
) -> None:
    """Each new thing takes at most four clicks; every view is accessible, and pictures of them are kept."""
    explored.game.begin(seed=1)
    page.reload()
    page.click("nav a[data-view=map]")
    page.select_option("#map-name", copy_of_map)
    page.wait_for_selector(f'#graph[data-nodes="{len(explored.result.truth.poses)}"]', timeout=WAIT_MS)
    graph = nx.Graph((edge["a"], edge["b"]) for edge in http.get(f"/api/maps/{copy_of_map}/edges").json())
    forbidden = spare(page, graph)
    name_three(page, [node for node in graph if node != forbidden], http, copy_of_map)
    forbid(page, forbidden, http, copy_of_map)
    looked_at(page, tmp_path / "map.png")
    teach(page, http, copy_of_map, explored)
    looked_at(page, tmp_path / "drive.png")
    with dispatch_of_the_first(explored.stack, tmp_path):
        schedule(page, tmp_path)
    report(page, tmp_path)


def spare(page: Any, graph: Any) -> int:
    """A node without which all others are joined, drawn farthest from its neighbours."""
    spots = {node: page.evaluate(SPOT, f"n{node}") for node in graph}
    cut = set(nx.articulation_points(graph))

    def room_px(node: int) -> float:
        x, y = spots[node]
        return float(min(max(abs(x - a), abs(y - b)) for n, (a, b) in spots.items() if n != node))

    return max((node for node in graph if node not in cut and node > 1), key=room_px)


def name_three(page: Any, nodes: list[int], http: httpx.Client, map_name: str) -> None:
    for name, node in zip(NAMES, nodes, strict=False):
        clicks = Clicks(page)
        clicks.on_node(node)
        clicks.on("#name-node")
        page.fill("#ask-value", name)
        clicks.on("#ask-yes")
        page.wait_for_selector(f"#places td:has-text('{name}')", timeout=WAIT_MS)
        assert clicks.count <= MOST_CLICKS
    places = {each["name"]: each["nodes"] for each in http.get(f"/api/maps/{map_name}/places").json()}
    assert places == {name: [node] for name, node in zip(NAMES, nodes, strict=False)}


def forbid(page: Any, node: int, http: httpx.Client, map_name: str) -> None:
    clicks = Clicks(page)
    clicks.on("#pick")
    clicks.drag_round(node)
    clicks.on("#forbid-picked")
    page.fill("#ask-value", "wet floor")
    clicks.on("#ask-yes")
    page.wait_for_selector('#graph[data-forbidden="1"]', timeout=WAIT_MS)
    (rule,) = http.get(f"/api/maps/{map_name}/rules").json()
    assert (rule["name"], rule["nodes"], clicks.count) == ("wet floor", [node], MOST_CLICKS)


def teach(page: Any, http: httpx.Client, map_name: str, explored: Explored) -> None:
    """Along the first edge of the map, by a key held down."""
    page.click("nav a[data-view=drive]")
    clicks = teaching_begun(page)
    mission = f"/api/robots/{explored.stack.robot}/mission"
    page.keyboard.down("ArrowUp")
    reached = wait_until(lambda: passed(http.get(mission).json()) >= 2, WAIT_S)
    page.keyboard.up("ArrowUp")
    assert reached, http.get(mission).json()
    clicks.on("#finish")
    page.wait_for_selector("#state.succeeded", timeout=WAIT_MS)
    assert clicks.count <= MOST_CLICKS
    route = http.get(f"/api/maps/{map_name}/route", params={"name": "tour"}).json()["nodes"]
    edges = {(edge["a"], edge["b"]) for edge in http.get(f"/api/maps/{map_name}/edges").json()}
    assert len(route) >= 2
    assert {(min(pair), max(pair)) for pair in pairwise(route)} <= edges


def passed(mission: dict[str, Any]) -> float:
    """Nodes that a robot that is taught has passed."""
    return float(next((each["value"] for each in mission["figures"] if each["name"] == "passed"), 0))


def schedule(page: Any, folder: Path) -> None:
    """A round of inspection at every minute, of which the first is watched to its end."""
    page.click("nav a[data-view=tasks]")
    clicks = Clicks(page)
    page.select_option("#mission-kind", "inspect")
    clicks.count += 1
    page.fill('#mission-parameters input[name="places"]', ", ".join(NAMES))
    page.fill("#schedule-name", "night")
    page.fill("#schedule-cron", "* * * * *")
    clicks.on("#set-schedule")
    page.wait_for_selector("#schedules td time", timeout=WAIT_MS)
    assert clicks.count <= MOST_CLICKS
    page.wait_for_selector("#task-list td:has-text('inspect')", timeout=2 * WAIT_MS)
    page.click("#schedules button:text-is('Turn off')")
    looked_at(page, folder / "tasks.png")
    page.wait_for_selector("#state.running", timeout=WAIT_MS)
    page.wait_for_selector("#state.succeeded", timeout=ROUND_MS)


def report(page: Any, folder: Path) -> None:
    page.click("nav a[data-view=map]")
    page.wait_for_selector("#inspections a", timeout=WAIT_MS)
    with page.expect_popup() as opened:
        page.click("#inspections a")
    told = opened.value
    told.wait_for_load_state()
    assert all(name in told.inner_text("body") for name in NAMES)
    assert told.locator("svg image").count() >= len(NAMES)
    looked_at(told, folder / "report.png")
    told.close()


def looked_at(page: Any, picture: Path) -> None:
    assert inaccessible(page) == [], picture.stem
    page.screenshot(path=picture)
