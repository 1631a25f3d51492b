"""A mission from a file of one's own is started over HTTP and seen in Runs and in the console."""

import json
import subprocess
import sys
from typing import Any

import httpx

from shared.bus import wait_until
from tests.browser import needs_chromium
from tests.e2e.one_stack.conftest import MAP, WAIT_S, Explored


def start(http: httpx.Client, robot: str, **parameters: object) -> httpx.Response:
    body = {"action": "wave", "map": MAP, "parameters": parameters}
    return http.post(f"/api/robots/{robot}/missions", json=body)


def test_it_runs_over_http_and_is_listed_among_the_runs(http: httpx.Client, explored: Explored) -> None:
    robot = explored.stack.robot
    started = start(http, robot, frames=4)
    assert started.status_code == 202, started.text
    mission_id = started.json()["mission_id"]
    wait = {"timeout_s": WAIT_S, "mission_id": mission_id}
    ended = http.get(f"/api/robots/{robot}/mission/wait", params=wait, timeout=2 * WAIT_S).json()
    assert (ended["mission"]["state"], ended["mission"]["reason"]) == ("succeeded", "seen 4 of 4 frames")

    def listed() -> list[Any]:
        return [run for run in http.get("/api/runs").json() if run["id"].endswith(mission_id)]

    assert wait_until(lambda: bool(listed()), WAIT_S)
    (run,) = listed()
    assert (run["kind"], run["title"], run["outcome"]) == ("wave", f"{robot}: wave in {MAP}", "succeeded")
    assert run["figures"]["frames_seen"] == 4
    assert run["figures"]["keypoints_seen"] > 100


def test_what_it_cannot_take_is_refused_by_name(http: httpx.Client, explored: Explored) -> None:
    answer = start(http, explored.stack.robot, frames=0)
    assert answer.status_code == 422
    assert "parameters of wave: frames" in answer.json()["got"]


@needs_chromium
def test_the_console_offers_it_with_its_parameters(browser: Any, explored: Explored) -> None:
    page = browser.new_page()
    try:
        page.goto(str(explored.stack.gateway_url))
        page.wait_for_selector('#mission-kind option[value="wave"]', state="attached", timeout=WAIT_S * 1000)
        page.select_option("#mission-kind", "wave")
        page.fill('#mission-parameters input[name="frames"]', "2")
        page.fill("#new-map", MAP)
        page.click("#start")
        page.wait_for_selector("#mission-facts:has-text('seen 2 of 2 frames')", timeout=WAIT_S * 1000)
        assert "Look about" in page.inner_text("#mission-facts")
    finally:
        page.close()


def test_it_is_known_to_the_command_line(explored: Explored) -> None:
    words = ["mission", "kinds", "--json", "--data-dir", str(explored.data_dir)]
    answer = subprocess.run(
        [sys.executable, "-m", "services.launcher", *words], capture_output=True, text=True, timeout=WAIT_S
    )
    assert answer.returncode == 0, answer.stderr
    kinds = {kind["name"]: kind for kind in json.loads(answer.stdout)}
    assert kinds["wave"]["parameters"]["properties"]["frames"]["maximum"] == 100


def test_the_command_line_starts_it(explored: Explored) -> None:
    words = [
        "mission",
        "start",
        "wave",
        "--map",
        MAP,
        "--set",
        "frames=2",
        "--data-dir",
        str(explored.data_dir),
    ]
    answer = subprocess.run(
        [sys.executable, "-m", "services.launcher", *words], capture_output=True, text=True, timeout=WAIT_S
    )
    assert answer.returncode == 0, answer.stderr
    assert "frames_seen" in answer.stdout
