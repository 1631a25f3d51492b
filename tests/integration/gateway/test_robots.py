"""Robots as the gateway sees them: frames, facts, the truth for debugging, health and counts."""

import io

import httpx
import numpy as np
import pytest
from PIL import Image

from shared.bus import Bus, wait_until
from shared.messages.missions import Event
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Pose, Truth
from shared.topics import EVENT, FRAME, RANGES, TRUTH
from tests.integration.gateway.gateway_process import WAIT_S


def frame(robot: str, seq: int) -> Frame:
    pixels = np.zeros((128, 256, 3), np.uint8)
    pixels[:, :, 0] = 240  # blue
    return Frame(seq=seq, robot=robot, encoding="bgr8", width_px=256, height_px=128, data=pixels.tobytes())


def ranges(robot: str) -> Ranges:
    angles = tuple(float(a) for a in np.linspace(-3, 3, 12))
    return Ranges(robot=robot, angles_rad=angles, distances_m=(1.0,) * 12, max_range_m=4.0)


def test_the_live_frame_is_a_jpeg_of_the_asked_width(http: httpx.Client, robot_bus: Bus) -> None:
    publisher = robot_bus.publisher(FRAME, robot="r1")

    def arrived() -> bool:
        publisher.put(frame("r1", 42))
        return http.get("/api/robots/r1/frame.jpg").status_code == 200

    assert wait_until(arrived, WAIT_S)
    answer = http.get("/api/robots/r1/frame.jpg?width=128")
    assert (answer.headers["content-type"], answer.headers["x-frame-seq"]) == ("image/jpeg", "42")
    picture = Image.open(io.BytesIO(answer.content))
    assert picture.size == (128, 64)
    red, _, blue = picture.getpixel((5, 5))  # type: ignore[misc]
    assert blue > 220 > 30 > red
    assert http.get("/api/robots/r1").json()["frame"]["seq"] == 42


def test_other_robots_are_found_by_what_they_say(http: httpx.Client, robot_bus: Bus) -> None:
    frames, sensed = robot_bus.publisher(FRAME, robot="r3"), robot_bus.publisher(RANGES, robot="r3")

    def arrived() -> bool:
        sensed.put(ranges("r3"))
        frames.put(frame("r3", 7))
        facts = http.get("/api/robots/r3").json()
        return facts.get("frame") is not None and facts.get("ranges") is not None

    assert wait_until(arrived, WAIT_S)
    listed = {entry["robot"]: entry for entry in http.get("/api/robots").json()}
    assert listed["r3"]["frame"]["width_px"] == 256
    assert listed["r3"]["ranges"]["distances_m"] == [1.0] * 12


def test_whoever_calls_itself_what_no_robot_may_keeps_nobody_from_being_heard(
    http: httpx.Client, robot_bus: Bus
) -> None:
    events, frames = robot_bus.publisher(EVENT, robot="r5"), robot_bus.publisher(FRAME, robot="r5")

    def heard() -> bool:
        events.put(Event(robot="missions", kind="here"))
        return any(entry["robot"] == "missions" for entry in http.get("/api/robots").json())

    def arrived() -> bool:
        events.put(Event(robot="r5", kind="here"))
        frames.put(frame("r5", 7))
        return http.get("/api/robots/r5").json().get("frame") is not None

    assert wait_until(heard, WAIT_S)
    assert wait_until(arrived, WAIT_S)


def test_the_truth_is_shown_only_where_asked_for(http: httpx.Client, robot_bus: Bus) -> None:
    publisher = robot_bus.publisher(TRUTH, robot="r4")
    truth = Truth(robot="r4", world="flat", pose=Pose(x_m=1.0, y_m=2.0, yaw_rad=0.5))

    def arrived() -> bool:
        publisher.put(truth)
        return http.get("/api/robots/r4/truth").status_code == 200

    assert wait_until(arrived, WAIT_S)
    assert http.get("/api/robots/r4/truth").json()["pose"] == {"x_m": 1.0, "y_m": 2.0, "yaw_rad": 0.5}
    assert "pose" not in http.get("/api/robots/r4").text
    assert http.get("/api/robots/r4/frame.jpg").json()["title"] == "no frame"


def test_decisions_are_kept_for_who_comes_later(http: httpx.Client, robot_bus: Bus) -> None:
    publisher = robot_bus.publisher(EVENT, robot="r11")

    def arrived() -> bool:
        publisher.put(Event(robot="r11", kind="replan", reason="lost"))
        return http.get("/api/robots/r11/events").status_code == 200

    assert wait_until(arrived, WAIT_S)
    assert http.get("/api/robots/r11/events?limit=1").json()[0]["reason"] == "lost"


@pytest.mark.parametrize("path", ["", "/frame.jpg", "/truth", "/events"])
def test_unknown_robots_are_not_found(http: httpx.Client, path: str) -> None:
    assert http.get(f"/api/robots/nobody{path}").status_code == 404


@pytest.mark.parametrize("width", ["0", "63", "4097", "x", "1e3"])
def test_the_width_has_bounds(http: httpx.Client, width: str) -> None:
    assert http.get(f"/api/robots/r1/frame.jpg?width={width}").status_code == 422


def test_malformed_messages_are_counted_and_do_no_harm(http: httpx.Client, robot_bus: Bus) -> None:
    session = robot_bus._session
    before = count(http, 'bus_faults_total{reason="malformed"}')

    def counted() -> bool:
        for junk in (b"", b"\xc1", b"\x81\xa6schema\xa8frame.v1", bytes(100)):
            session.put("topnav/r1/status", junk)
        return count(http, 'bus_faults_total{reason="malformed"}') >= before + 4

    assert wait_until(counted, WAIT_S)
    assert http.get("/healthz").status_code == 200


def test_readiness_names_what_is_missing(http: httpx.Client, robot_bus: Bus) -> None:
    def missing() -> list[str]:
        answer = http.get("/readyz")
        return answer.json()["missing"] if answer.status_code == 503 else []

    assert wait_until(lambda: missing() == ["map_store", "drive"], WAIT_S)
    robot_bus.announce("map_store")
    assert wait_until(lambda: missing() == ["drive"], WAIT_S)
    robot_bus.announce("drive")
    assert wait_until(lambda: http.get("/readyz").status_code == 200, WAIT_S)
    needed = {"features", "gateway", "map_store", "planner", "drive"}
    assert set(http.get("/readyz").json()["services"]) >= needed


def test_errors_outside_the_api_are_problems_too(http: httpx.Client) -> None:
    for answer in (
        http.get("/nothing"),
        http.delete("/healthz"),
        http.get("/static/none.js"),
        http.get("/static/../app.py"),
    ):
        assert answer.status_code in (404, 405)
        assert answer.headers["content-type"] == "application/problem+json"
        assert {"type", "title", "status", "detail", "expected", "got", "next"} <= answer.json().keys()
    assert http.delete("/healthz").headers["allow"] == "GET"


def test_pages_carry_a_strict_policy_and_fetch_nothing_from_elsewhere(http: httpx.Client) -> None:
    answer = http.get("/")
    assert answer.headers["content-security-policy"].startswith("default-src 'self';")
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "//" not in answer.text.replace("<!doctype html>", "")


def test_the_description_of_the_interface_is_complete(http: httpx.Client) -> None:
    paths = http.get("/openapi.json").json()["paths"]
    assert {
        "/api/robots/{robot}/goal-check",
        "/api/robots/{robot}/missions",
        "/api/maps/{map_name}/undo",
    } <= set(paths)
    assert "multipart/form-data" in paths["/api/robots/{robot}/goal-check"]["post"]["requestBody"]["content"]


def test_a_burst_of_frames_leaves_the_newest(http: httpx.Client, robot_bus: Bus) -> None:
    publisher = robot_bus.publisher(FRAME, robot="r1")

    def newest() -> bool:  # the last one, too, may be dropped on its way
        publisher.put(frame("r1", 159))
        return ((http.get("/api/robots/r1").json().get("frame") or {}).get("seq")) == 159

    for seq in range(100, 160):
        publisher.put(frame("r1", seq))
    assert wait_until(newest, WAIT_S)


def count(http: httpx.Client, name: str) -> float:
    for line in http.get("/metrics").text.splitlines():
        if line.startswith(f"topnav_gateway_{name} "):
            return float(line.split()[-1])
    return 0.0
