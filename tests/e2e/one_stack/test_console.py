"""The console in a real browser, on real processes and the simulator: what a team does with it all day."""

import io
import re
import threading
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from PIL import Image

from services.recorder.player import Player, play
from services.recorder.reading import read
from services.recorder.recorder import record
from services.recorder.recording import RecordingWriter
from shared.bus import open_bus, wait_until
from shared.lifecycle import in_thread
from shared.messages.sensors import Frame
from shared.topics import FRAME
from tests.browser import WAIT_MS, inaccessible, listen, needs_chromium
from tests.e2e.near_node import hiding_place_near_a_node
from tests.e2e.one_stack.conftest import MAP, WAIT_S, Explored

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600), needs_chromium]

VIEWS = ("drive", "map", "why", "maps", "runs", "tasks")
MISSION_MS = 240_000

COLOURS = """() => {
    const context = document.querySelector(".pair").getContext("2d");
    return new Set(context.getImageData(0, 0, 720, 740).data).size;
}"""


class Late:
    """Requests of the page that wait until they are let through."""

    def __init__(self) -> None:
        self.held: list[Any] = []
        self.open = False

    def take(self, route: Any) -> None:
        if self.open:
            route.continue_()
        else:
            self.held.append(route)

    def arrive(self) -> None:
        self.open = True
        for route in self.held:
            route.continue_()


@pytest.fixture
def page(browser: Any, explored: Explored) -> Iterator[Any]:
    """The opened page; at the end nothing may have been wrong with it."""
    opened, faults = browser.new_page(viewport={"width": 1440, "height": 900}), []
    listen(opened, str(explored.stack.gateway_url), faults)
    opened.goto(str(explored.stack.gateway_url))
    opened.wait_for_selector("#connection.up", timeout=WAIT_MS)
    yield opened
    opened.close()
    assert faults == []


@pytest.fixture
def copy_of_map(http: httpx.Client) -> Iterator[str]:
    """Another map with the same places, to be changed."""
    archive = http.get(f"/api/maps/{MAP}/export").content
    assert http.patch(f"/api/maps/{MAP}", json={"name": "kept"}).status_code == 200
    answer = http.post("/api/maps/import", content=archive, headers={"Content-Type": "application/zip"})
    assert answer.status_code == 201, answer.text
    assert http.patch(f"/api/maps/{MAP}", json={"name": "copied"}).status_code == 200
    assert http.patch("/api/maps/kept", json={"name": MAP}).status_code == 200
    yield "copied"
    http.delete("/api/maps/copied")


@pytest.fixture
def succeeded(explored: Explored, http: httpx.Client) -> None:
    """A mission that succeeded is among the decisions that the gateway remembers."""

    def told() -> bool:
        answer = http.get(f"/api/robots/{explored.stack.robot}/events?limit=200")
        return answer.status_code == 200 and any(event["kind"] == "succeeded" for event in answer.json())

    if not told():
        game = explored.game
        start = game.begin(seed=1).pose
        hider = hiding_place_near_a_node(explored.result, explored.space, start)
        game.seek(start, hider, seed=2, max_steps=200)
    assert wait_until(told, WAIT_S)


def test_from_the_opened_page_to_a_robot_at_an_uploaded_picture(page: Any, explored: Explored) -> None:
    """A stranger needs two clicks: choose the picture, drive there."""
    game = explored.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(explored.result, explored.space, start)
    page.wait_for_selector("#frame:visible", timeout=WAIT_MS)
    goal = {"name": "goal.png", "mimeType": "image/png", "buffer": png_of(game.hide(hider))}
    page.set_input_files("#picture", files=[goal])
    page.wait_for_selector("#goal-answer .verdict.found", timeout=WAIT_MS)
    page.check("#show-matches")
    page.click("#go")
    page.wait_for_selector("#frame-matches circle.inlier", state="attached", timeout=WAIT_MS)
    page.wait_for_selector("#polar .bar", state="attached", timeout=WAIT_MS)
    page.wait_for_selector("#state.succeeded", timeout=MISSION_MS)
    page.wait_for_selector("#events li.good", timeout=WAIT_MS)


@pytest.mark.usefixtures("succeeded")
def test_a_decision_leads_to_its_moment_and_the_charts(page: Any) -> None:
    page.goto(f"{page.url}#why")
    page.wait_for_selector("#charts .uplot", timeout=WAIT_MS)
    assert page.locator("#charts .uplot").count() == 3
    page.select_option("#kind", "succeeded")
    page.wait_for_selector("#events:not(:has(li:not(.good))) li.good b:text-is('succeeded')", timeout=WAIT_MS)
    page.fill("#event-text", "no such words")
    page.wait_for_selector("#events li.quiet", timeout=WAIT_MS)


def test_an_edge_shows_both_pictures_and_its_matches(page: Any, explored: Explored) -> None:
    page.goto(f"{page.url}#map")
    page.wait_for_selector(f'#graph[data-nodes="{len(explored.result.truth.poses)}"]', timeout=WAIT_MS)
    page.fill("#find", "0-1")
    page.press("#find", "Enter")
    page.wait_for_selector("#pair-answer[data-drawn]", timeout=WAIT_MS)
    assert re.search(r"\d+ of \d+ matches agree", page.inner_text("#pair-answer"))
    assert page.evaluate(COLOURS) > 100
    page.click("#inspector button:text-is('Node 1')")
    page.wait_for_selector("#inspector figure canvas", timeout=WAIT_MS)
    with page.expect_response(lambda answer: "/true-positions" in answer.url, timeout=WAIT_MS):
        page.check("#true-positions")
    page.wait_for_timeout(500)  # a refusal takes the tick away
    assert page.is_checked("#true-positions"), page.inner_text("#said")


def test_a_deleted_place_comes_back_by_undo_and_the_history_says_who(copy_of_map: str, page: Any) -> None:
    """The page comes after the copy and goes before it: it complains about maps that are not there."""
    page.goto(f"{page.url}#maps")
    page.click(f"#maps-table button:text-is('{copy_of_map}')", timeout=WAIT_MS)
    before = int(page.inner_text(f"#maps-table tr:has(button:text-is('{copy_of_map}')) td:nth-child(2)"))
    late = Late()
    page.route(f"**/api/maps/{copy_of_map}/nodes", late.take)
    page.reload()
    page.click("nav a[data-view=map]")
    page.select_option("#map-name", copy_of_map)
    page.fill("#find", "1")
    page.press("#find", "Enter")
    late.arrive()
    page.click("#remove")
    page.click("#confirm-yes")
    page.wait_for_selector(f'#graph[data-nodes="{before - 1}"]', timeout=WAIT_MS)
    page.click("nav a[data-view=maps]")
    page.wait_for_selector("#revisions td:text-is('console')", timeout=WAIT_MS)
    page.click("#undo")
    page.click("#confirm-yes")
    page.click("nav a[data-view=map]")
    page.wait_for_selector(f'#graph[data-nodes="{before}"]', timeout=WAIT_MS)
    page.click("nav a[data-view=maps]")
    page.wait_for_selector("#revisions tbody tr:first-child:has-text('takes back')", timeout=WAIT_MS)
    page.locator("#revisions input[type=checkbox]").nth(0).check()
    page.locator("#revisions input[type=checkbox]").nth(1).check()
    page.click("#compare")
    page.wait_for_selector("#comparison:has-text('1 nodes added')", timeout=WAIT_MS)


def test_the_stop_button_stops_until_a_person_lets_the_robot_go(page: Any) -> None:
    page.click("#estop")
    page.wait_for_selector("#estop-notice:not([hidden])", timeout=WAIT_MS)
    page.reload()
    page.wait_for_selector("#estop-notice:has-text('Emergency stop by console')", timeout=WAIT_MS)
    page.click("#estop-clear")
    page.fill("#ask-value", "ada")
    page.click("#ask-yes")
    page.wait_for_selector("#estop-notice", state="hidden", timeout=WAIT_MS)


def test_a_recording_plays_as_if_live(page: Any, explored: Explored, tmp_path: Any) -> None:
    file = tmp_path / "ghost.mcap"
    pictures = FRAME.key(robot=explored.stack.robot)
    with (
        RecordingWriter(file) as writer,
        open_bus(explored.stack.endpoint) as bus,
        in_thread(lambda stop: record(bus, writer, frozenset(), stop, None), "recorder"),
    ):
        explored.game.begin(seed=3)
        assert wait_until(lambda: writer.counts[pictures] >= 6, WAIT_S)
    with open_bus(explored.stack.endpoint) as bus:
        player = Player(bus, {"r1": "ghost"}, frozenset({"delta"}))

        def over_and_over(stop: threading.Event) -> None:
            while not stop.is_set():
                play(read(file), player.put, 1.0, stop)

        with in_thread(over_and_over, "player"):
            page.wait_for_selector("#robot option[value=ghost]", state="attached", timeout=WAIT_MS)
            page.select_option("#robot", "ghost")
            page.wait_for_selector("#frame:visible", timeout=WAIT_MS)
            assert "frame" in page.inner_text("#frame-facts")


def test_every_view_is_accessible_and_well_behaved(page: Any) -> None:
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        for view in VIEWS:
            page.click(f"nav a[data-view={view}]")
            page.wait_for_timeout(400)
            assert inaccessible(page) == [], f"{view}, {scheme}"


def test_the_policy_allows_no_inline_scripts_and_the_page_is_small(browser: Any, explored: Explored) -> None:
    sizes: dict[str, int] = {}
    address = str(explored.stack.gateway_url)
    with browser.new_page() as page:
        session = page.context.new_cdp_session(page)
        session.send("Network.enable")
        urls: dict[str, str] = {}
        session.on(
            "Network.requestWillBeSent", lambda e: urls.__setitem__(e["requestId"], e["request"]["url"])
        )
        session.on(
            "Network.loadingFinished",
            lambda e: sizes.__setitem__(urls.get(e["requestId"], ""), int(e["encodedDataLength"])),
        )
        for view in VIEWS:
            page.goto(f"{address}/#{view}")
            page.wait_for_timeout(600)
        page.goto(f"{address}/#drive")
        page.check("#look-around")
        page.wait_for_selector("#around canvas", timeout=WAIT_MS)
    policy = httpx.get(address, trust_env=False, timeout=WAIT_S).headers["Content-Security-Policy"]
    assert "unsafe" not in policy
    assert sum(size for url, size in sizes.items() if "/static/" in url) <= 400_000


def test_the_page_finds_a_gateway_again_that_was_killed(browser: Any, explored: Explored) -> None:
    launcher = explored.stack.launcher
    assert launcher is not None
    page = browser.new_page()
    page.goto(str(explored.stack.gateway_url))
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    before = launcher.kill("gateway")
    page.wait_for_selector("#notice:has-text('lost')", timeout=WAIT_MS)
    launcher.wait_healthy("gateway", 2 * WAIT_S, other_than=before)
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    page.wait_for_selector("#notice", state="hidden", timeout=WAIT_MS)
    page.close()


def png_of(frame: Frame) -> bytes:
    """A frame of the bus as a file."""
    out = io.BytesIO()
    image = Image.frombuffer("RGB", (frame.width_px, frame.height_px), frame.data, "raw", "BGR", 0, 1)
    image.save(out, "PNG")
    return out.getvalue()
