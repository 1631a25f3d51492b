"""The queue in the console: added to, moved, cancelled, scheduled; in four clicks at most."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from shared.bus import wait_until
from tests.browser import WAIT_MS, listen, needs_chromium, require_accessible
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.test_tasks import ERRAND, FLEET_URL, SCHEDULES_URL, TASKS_URL, Store
from tests.integration.gateway.test_tasks import store as store

pytestmark = needs_chromium


@pytest.fixture
def page(browser: Any, gateway: str, store: Store) -> Iterator[Any]:
    """The tasks of a robot; at the end nothing may have been wrong with the page."""
    assert store
    opened, faults = browser.new_page(viewport={"width": 1440, "height": 900}), []
    listen(opened, gateway, faults)
    opened.goto(f"{gateway}/#tasks")
    opened.wait_for_selector("#queue-it:enabled", timeout=WAIT_MS)
    yield opened
    opened.close()
    assert [fault for fault in faults if "status of 422" not in fault] == []  # what one test provokes


def states(http: httpx.Client) -> dict[str, str]:
    listed = http.get(TASKS_URL).json()
    return {task["task_id"]: task["state"] for task in (*listed["tasks"], *listed["ended"])}


def test_the_mission_of_the_form_is_queued_by_one_click(page: Any, http: httpx.Client):
    page.click("#queue-it")
    page.wait_for_selector("#task-list td:has-text('explore in flat')", timeout=WAIT_MS)
    (task,) = http.get(TASKS_URL).json()["tasks"]
    assert (task["kind"], task["map"], task["state"]) == ("explore", "flat", "queued")


def test_a_task_is_moved_and_cancelled(page: Any, http: httpx.Client, store: Store):
    for task_id in ("one", "two"):
        http.post(TASKS_URL, json={**ERRAND, "task_id": task_id})
    page.wait_for_selector("#task-list tbody tr:nth-child(2)", timeout=WAIT_MS)
    page.select_option("#task-list tbody tr:nth-child(2) select", "9")
    assert wait_until(
        lambda: [one["task_id"] for one in http.get(TASKS_URL).json()["tasks"]] == ["two", "one"], WAIT_S
    )
    page.wait_for_selector("#task-list tbody tr:first-child span[title^=two]", timeout=WAIT_MS)
    page.click("#task-list tbody tr:nth-child(2) button")
    page.wait_for_selector("#ended-tasks span.cancelled", timeout=WAIT_MS)
    assert states(http) == {"one": "cancelled", "two": "queued"}
    store.begin("two")
    page.wait_for_selector("#task-list span.state:text-is('running')", timeout=WAIT_MS)
    page.click("#task-list button")
    page.click("#confirm-yes")


def test_a_task_for_any_robot_is_queued_shown_with_the_one_that_has_it_and_cancelled(
    page: Any, http: httpx.Client, store: Store
):
    http.post(TASKS_URL, json={**ERRAND, "task_id": "own"})
    page.check("#whole-fleet")
    page.wait_for_selector("#queue-why:text('no fleet service')", timeout=WAIT_MS)
    page.click("#queue-it")
    page.wait_for_selector("#task-list td:has-text('explore in flat')", timeout=WAIT_MS)
    (task,) = http.get(FLEET_URL).json()["tasks"]
    assert (task["kind"], task["robot"]) == ("explore", "any")
    store.hand_over(task["task_id"])
    page.wait_for_selector("#task-list td:has-text('explore in flat, r1')", timeout=WAIT_MS)
    page.click("#task-list button")
    page.wait_for_selector("#ended-tasks span.cancelled", timeout=WAIT_MS)
    page.uncheck("#whole-fleet")
    page.wait_for_selector("#task-list td:has-text('goto in flat')", timeout=WAIT_MS)
    assert states(http)["own"] == "queued"


def test_a_schedule_is_set_turned_off_and_removed(page: Any, http: httpx.Client):
    page.fill("#schedule-name", "night")
    page.fill("#schedule-cron", "30 22 * * MON-FRI")
    page.fill("#schedule-zone", "Europe/Zurich")
    page.click("#set-schedule")
    page.wait_for_selector("#schedules td time", timeout=WAIT_MS)
    assert http.get(f"{SCHEDULES_URL}/night").json()["task"]["kind"] == "explore"
    page.click("#schedules button:text-is('Turn off')")
    page.wait_for_selector("#schedules td:text-is('off')", timeout=WAIT_MS)
    page.click("#schedules button:text-is('Remove')")
    page.click("#confirm-yes")
    page.wait_for_selector("#schedules p", timeout=WAIT_MS)
    assert http.get(SCHEDULES_URL).json() == []


def test_a_wrong_schedule_is_told(page: Any):
    page.fill("#schedule-name", "night")
    page.fill("#schedule-cron", "0 25 * * *")
    page.click("#set-schedule")
    page.wait_for_selector("#said:has-text('field hour cannot be')", timeout=WAIT_MS)


def test_the_view_is_accessible(page: Any, http: httpx.Client, store: Store, tmp_path: Path):
    for task_id in ("one", "two", "three"):
        http.post(TASKS_URL, json={**ERRAND, "task_id": task_id})
    http.delete(f"{TASKS_URL}/three")
    store.begin("one")
    errand = {"cron": "30 22 * * *", "time_zone": "Europe/Zurich", "task": ERRAND}
    assert http.put(f"{SCHEDULES_URL}/night", json=errand).status_code == 200
    page.wait_for_selector("#schedules td time", timeout=WAIT_MS)
    page.wait_for_selector("#task-list span.state:text-is('running')", timeout=WAIT_MS)
    require_accessible(page, tmp_path)
