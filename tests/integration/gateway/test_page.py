"""The page in a real browser: it loads offline, uploads a picture, shows the answer, steers the robot."""

import io
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from shared.bus import Bus, open_bus, wait_until
from shared.messages.body import Battery, Imu, Odometry
from shared.messages.camera import CameraState
from shared.messages.missions import Event, MissionStatus
from shared.messages.sensors import Frame
from shared.topics import BATTERY, CAMERA_STATE, EVENT, FRAME, IMU, MANUAL, ODOMETRY, STATUS
from tests.browser import WAIT_MS, listen, needs_chromium
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, free_port
from tests.integration.gateway.standins import Planner

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = needs_chromium


@pytest.fixture
def page(browser: "Browser", gateway: str) -> Iterator["Page"]:
    """The page, with everything it complains about or fetches from elsewhere collected."""
    opened = browser.new_page(viewport={"width": 1400, "height": 1000})
    faults: list[str] = []
    listen(opened, gateway, faults)
    opened.goto(gateway)
    yield opened
    opened.close()
    assert [fault for fault in faults if "status of 415" not in fault] == []  # the refusal one test provokes


def picture() -> bytes:
    out = io.BytesIO()
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (128, 256, 3), np.uint8)).save(out, "PNG")
    return out.getvalue()


@pytest.mark.usefixtures("map_store")
def test_an_uploaded_picture_is_localised_and_driven_to(page: "Page", planner: Planner) -> None:
    page.wait_for_selector('#graph[data-nodes="5"]', timeout=WAIT_MS)
    goal = {"name": "goal.png", "mimeType": "image/png", "buffer": picture()}
    page.set_input_files("#picture", files=[goal])
    page.wait_for_selector("#goal-answer .verdict.found", timeout=WAIT_MS)
    assert "71 of 150" in page.inner_text("#goal-answer")
    before = len(planner.asked)
    page.click("#go")
    assert wait_until(
        lambda: any(w.goal is not None and w.action == "goto" for w in planner.asked[before:]), WAIT_S
    )
    page.wait_for_selector("#state.running", timeout=WAIT_MS)
    page.click("#cancel")
    page.wait_for_selector("#state.cancelled", timeout=WAIT_MS)


PREVIEWED = """() => {
    const canvas = document.getElementById("preview");
    if (canvas.hidden) return null;
    const row = canvas.getContext("2d").getImageData(0, canvas.height / 2, canvas.width, 1).data;
    return [...Array(canvas.width).keys()].filter((x) => row[4 * x + 3] > 0).length / canvas.height;
}"""
"""Width over height of what the preview shows."""


@pytest.mark.parametrize(("size", "shape"), [((256, 128), 2.0), ((400, 300), 4 / 3), ((300, 400), 0.75)])
@pytest.mark.usefixtures("map_store")
def test_a_picture_is_shown_in_its_own_shape(page: "Page", size: tuple[int, int], shape: float) -> None:
    page.wait_for_selector("#map-name option", state="attached", timeout=WAIT_MS)
    out = io.BytesIO()
    Image.new("RGB", size, (90, 120, 30)).save(out, "JPEG")
    goal = {"name": "goal.jpg", "mimeType": "image/jpeg", "buffer": out.getvalue()}
    page.set_input_files("#picture", files=[goal])
    page.wait_for_selector("#goal-answer .verdict", timeout=WAIT_MS)
    page.wait_for_function(PREVIEWED, timeout=WAIT_MS)
    assert page.evaluate(PREVIEWED) == pytest.approx(shape, abs=0.02)


def test_a_broken_picture_is_explained(page: "Page") -> None:
    page.wait_for_selector("#map-name option", state="attached", timeout=WAIT_MS)
    goal = {"name": "goal.gif", "mimeType": "image/gif", "buffer": b"GIF89a"}
    with page.expect_response(lambda response: "goal-check" in response.url) as answer:
        page.set_input_files("#picture", files=[goal])
    assert answer.value.status == 415
    page.wait_for_selector("#goal-answer .bad", timeout=WAIT_MS)
    assert "image/png" in page.inner_text("#goal-answer")
    assert page.is_disabled("#go")


def test_picture_status_and_decisions_are_live(page: "Page", robot_bus: Bus, planner: Planner) -> None:
    frames, events = robot_bus.publisher(FRAME, robot="r1"), robot_bus.publisher(EVENT, robot="r1")
    statuses = robot_bus.publisher(STATUS, robot="r1")
    pixels = np.full((128, 256, 3), 90, np.uint8).tobytes()
    seq = 1000

    def shown() -> bool:
        nonlocal seq
        seq += 1
        frames.put(Frame(seq=seq, robot="r1", encoding="bgr8", width_px=256, height_px=128, data=pixels))
        page.wait_for_timeout(100)
        return page.is_visible("#frame")

    def told() -> bool:  # again and again, as the bus may drop one behind the pictures
        events.put(Event(seq=1, robot="r1", kind="replan", reason="<b>lost</b>: S 31 below 60"))
        page.wait_for_timeout(100)
        return page.is_visible("#events li.bad")

    assert wait_until(shown, 2 * WAIT_S)
    assert wait_until(told, 2 * WAIT_S)
    assert "<b>lost</b>" in page.inner_text("#events")
    planner.status = MissionStatus(
        robot="r1",
        mission_id="m1",
        action="goto",
        map="flat",
        state="running",
        via_points=(0, 1, -1),
        nearest_node=1,
    )
    path = page.locator("#path-text:text-is('path 0 → 1 → goal; robot near node 1')")

    def drawn() -> bool:
        statuses.put(planner.status)
        page.wait_for_timeout(100)
        return path.count() > 0

    assert wait_until(drawn, 2 * WAIT_S)


def test_a_place_shows_its_connections_and_takes_the_robot_there(page: "Page", planner: Planner) -> None:
    planner.status = MissionStatus(robot="r1")
    page.wait_for_selector('#graph[data-nodes="5"]', timeout=WAIT_MS)
    page.fill("#find", "2")
    page.press("#find", "Enter")
    page.wait_for_selector("#inspector table", timeout=WAIT_MS)
    assert "suspended" in page.inner_text("#inspector")
    before = len(planner.asked)
    page.click("#go-there")
    assert wait_until(lambda: any(wish.goal_node == 2 for wish in planner.asked[before:]), WAIT_S)


def test_a_lost_gateway_is_said_and_found_again(browser: "Browser", endpoint: str) -> None:
    port = free_port()
    running = serve_gateway(endpoint, port=port)
    page = browser.new_page()
    page.goto(next(running))
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    page.wait_for_selector("#notice", state="hidden", timeout=WAIT_MS)
    assert next(running, None) is None  # stops the gateway
    page.wait_for_selector("#notice:has-text('lost')", timeout=WAIT_MS)
    again = serve_gateway(endpoint, port=port)
    next(again)
    page.wait_for_selector("#connection.up", timeout=WAIT_MS)
    page.wait_for_selector("#notice", state="hidden", timeout=WAIT_MS)
    page.close()
    assert next(again, None) is None


def test_positions_follow_the_headings(page: "Page") -> None:
    """An L of three places: ahead, then left, though the second camera looks backwards."""
    spots = page.evaluate(
        """async () => {
            const { place } = await import("/static/map/layout.js");
            const edge = (a, b, ab, ba, yaw) =>
                ({ a, b, heading_ab_rad: ab, heading_ba_rad: ba, yaw_ab_rad: yaw, confidence: 1 });
            const nodes = [0, 1, 2].map((node_id) => ({ node_id }));
            const edges = [edge(0, 1, 0, 0, Math.PI), edge(1, 2, -Math.PI / 2, 0, -Math.PI / 2)];
            const spots = place(nodes, edges);
            return [0, 1, 2].map((id) => [spots.get(id).x, spots.get(id).y]);
        }"""
    )
    found = np.array(spots) - spots[0]
    np.testing.assert_allclose(found, [[0, 0], [1, 0], [1, 1]], atol=0.2)


def test_keys_and_stick_drive_by_hand_until_the_page_lets_go(page: "Page", robot_bus: Bus) -> None:
    wishes = robot_bus.subscribe(MANUAL, robot="r1")
    page.wait_for_selector("#map-name option", state="attached", timeout=WAIT_MS)

    def said(**wanted: float | str) -> bool:
        came = wishes.take_all()
        return any(all(getattr(wish, k) == v for k, v in wanted.items()) for wish in came)

    def drives(**wanted: float | str) -> None:
        assert wait_until(lambda: page.wait_for_timeout(50) or said(**wanted), WAIT_S)

    page.check("#by-hand")
    drives(who="console", forward_mps=0.0, turn_radps=0.0)
    page.keyboard.down("KeyW")
    page.keyboard.down("KeyA")
    drives(forward_mps=0.4, turn_radps=1.0)
    page.keyboard.up("KeyW")
    page.keyboard.up("KeyA")
    drives(forward_mps=0.0, turn_radps=0.0)
    box = page.locator("#stick").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"])
    drives(forward_mps=-0.4, turn_radps=0.0)
    page.mouse.up()
    page.uncheck("#by-hand")
    drives(action="release")
    assert page.is_hidden("#stick")
    page.keyboard.press("KeyW")
    page.wait_for_timeout(300)
    assert not said(action="drive")
    page.check("#by-hand")
    drives(action="drive")
    page.click("nav a[data-view=tasks]")
    drives(action="release")


def test_to_let_go_comes_after_a_wish_that_is_late(page: "Page", robot_bus: Bus) -> None:
    wishes, held = robot_bus.subscribe(MANUAL, robot="r1"), []
    page.wait_for_selector("#map-name option", state="attached", timeout=WAIT_MS)
    page.route("**/drive", lambda route: route.continue_() if held else held.append(route))

    def heard(action: str) -> bool:
        page.wait_for_timeout(50)
        return any(wish.action == action for wish in wishes.take_all())

    page.check("#by-hand")
    assert wait_until(lambda: page.wait_for_timeout(50) or bool(held), WAIT_S)
    page.uncheck("#by-hand")
    page.wait_for_timeout(300)
    assert not heard("release")
    held[0].continue_()
    assert wait_until(lambda: heard("release"), WAIT_S)
    page.wait_for_timeout(300)
    assert not heard("drive")


def test_what_a_robot_says_of_its_body_is_shown(page: "Page", robot_bus: Bus) -> None:
    said = [
        (robot_bus.publisher(BATTERY, robot="r1"), Battery(robot="r1", share=0.62, charging=True)),
        (robot_bus.publisher(ODOMETRY, robot="r1"), Odometry(robot="r1", x_m=1.5, yaw_rad=1.57)),
        (robot_bus.publisher(IMU, robot="r1"), Imu(robot="r1", gravity=(0.0, 0.1, -0.99499))),
        (
            robot_bus.publisher(CAMERA_STATE, robot="r1"),
            CameraState(robot="r1", source="osc://camera", model="RICOH THETA Z1", rate_hz=8.0, delay_s=0.4),
        ),
    ]
    page.wait_for_selector("#map-name option", state="attached", timeout=WAIT_MS)
    assert page.is_hidden("#body-facts")
    expected = (
        "battery 62 % charging",
        "1.5 m ahead",
        "90\u00b0",
        "leaning 5.7\u00b0",
        "Z1: 8.0 Hz, 400 ms late",
    )

    def shown() -> bool:
        for publisher, message in said:
            publisher.put(message)
        page.wait_for_timeout(200)
        return all(part in page.inner_text("#body-facts") for part in expected)

    assert wait_until(shown, WAIT_S), page.inner_text("#body-facts")


def test_a_service_that_not_everybody_runs_is_missed_once_it_was_there(page: "Page", endpoint: str) -> None:
    page.wait_for_selector("#services li.missing:has-text('simulator')", timeout=WAIT_MS)
    assert page.locator("#services li:has-text('dispatch')").count() == 0
    with open_bus(endpoint) as bus:
        bus.announce("dispatch")
        page.wait_for_selector("#services li.alive:has-text('dispatch')", timeout=WAIT_MS)
    page.wait_for_selector("#services li.missing:has-text('dispatch')", timeout=WAIT_MS)


def test_no_simulator_is_missed_where_a_real_robot_is(page: "Page", robot_bus: Bus) -> None:
    page.wait_for_selector("#services li.missing:has-text('simulator')", timeout=WAIT_MS)
    robot_bus.announce("ros")
    page.wait_for_selector("#services li.alive:has-text('ros')", timeout=WAIT_MS)
    assert page.locator("#services li:has-text('simulator')").count() == 0
