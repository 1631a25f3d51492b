"""Queued tasks carried out by real processes: one after the other, stopped, refused, kept from going home."""

import subprocess

import pytest

from shared.bus import Bus
from shared.messages.missions import MissionRequest
from shared.messages.tasks import QueueStatus
from shared.queries import RefusedError
from shared.topics import MISSION, QUEUE
from tests.integration.dispatch.conftest import ANSWER_S, Queue
from tests.integration.dispatch.robot import Robot, until

LONG = 10_000


def mission(bus: Bus, action: str, **fields: object):
    return bus.ask(MISSION, MissionRequest(action=action, **fields), ANSWER_S, robot="r1")


def test_tasks_are_carried_out_one_after_the_other_by_priority_with_their_ids(queue: Queue, bus: Bus):
    queue.add("first", frames=LONG)
    queue.wait("first", "running")
    for task_id, priority in (("later", 2), ("sooner", 8)):
        queue.add(task_id)
        queue.ask("prioritize", task_id=task_id, priority=priority)
    assert mission(bus, "status").mission_id == "first"
    mission(bus, "cancel", mission_id="first")
    later, sooner, first = (
        queue.wait(name, "succeeded", "cancelled") for name in ("later", "sooner", "first")
    )
    assert (first.state, sooner.state, later.state) == ("cancelled", "succeeded", "succeeded")
    assert first.ended_ns <= sooner.started_ns < sooner.ended_ns <= later.started_ns


def test_a_control_is_for_the_mission_that_it_names(queue: Queue, bus: Bus):
    queue.add("named", frames=LONG)
    queue.wait("named", "running")
    with pytest.raises(RefusedError, match="mission other is not the one of now"):
        mission(bus, "cancel", mission_id="other")
    assert queue.task("named").state == "running"


def test_a_task_that_the_planner_refuses_has_failed_with_its_reason_and_the_next_begins(queue: Queue):
    queue.add("nowhere", kind="home")
    queue.add("after-it")
    refused = queue.wait("nowhere", "failed")
    assert (refused.failure, "no place 'home'" in refused.reason) == ("refused", True)
    queue.wait("after-it", "succeeded")


def test_a_task_goes_on_after_the_emergency_stop_was_cleared_unless_a_person_paused_it(
    queue: Queue, robot: Robot, bus: Bus
):
    def state() -> tuple[str, str]:
        status = mission(bus, "status")
        return status.state, status.paused_by

    queue.add("long", frames=LONG)
    queue.wait("long", "running")
    robot.stop(True)
    until(lambda: state() == ("paused", "emergency_stop"), ANSWER_S, "it does not pause")
    robot.stop(False)
    until(lambda: state() == ("running", ""), ANSWER_S, "it does not go on")
    robot.stop(True)
    until(lambda: state() == ("paused", "emergency_stop"), ANSWER_S, "it does not pause again")
    assert mission(bus, "pause").paused_by == "person"
    robot.stop(False)
    queue.add("next")
    for _ in range(20):
        assert state() == ("paused", "person")
    assert queue.task("next").state == "queued"


def test_nothing_begins_while_the_emergency_stop_is_engaged(queue: Queue, robot: Robot, bus: Bus):
    statuses = bus.subscribe(QUEUE, robot="r1")
    robot.stop(True)
    told = QueueStatus(robot="r1")

    def says(why: str) -> bool:
        nonlocal told
        told = statuses.take() or told
        return told.why == why

    statuses.take_all()
    until(lambda: statuses.take(), ANSWER_S, "it says nothing")
    until(lambda: statuses.take(), ANSWER_S, "it has not listened since")
    queue.add("stopped")
    until(lambda: says("the emergency stop is engaged"), ANSWER_S, f"it says {told}")
    assert queue.task("stopped").state == "queued"
    robot.stop(False)
    queue.wait("stopped", "succeeded")


def test_a_low_battery_ends_in_an_alarm_where_there_is_no_home_and_the_task_goes_on_when_it_is_charged(
    queue: Queue, robot: Robot, bus: Bus
):
    def under_way(task_id: str) -> bool:
        status = mission(bus, "status")
        return status.mission_id == task_id and status.step > 5

    statuses = bus.subscribe(QUEUE, robot="r1")
    queue.add("round", frames=60)
    until(lambda: under_way("round"), ANSWER_S, "it does not begin")
    robot.charge = 0.1
    told: list[QueueStatus] = []
    until(
        lambda: told.extend(statuses.take_all()) or any("did not get home" in one.alarm for one in told),
        ANSWER_S,
        "no alarm",
    )
    waits = queue.task("round")
    assert (waits.state, waits.checkpoint["counted"] > 5) == ("queued", True)
    robot.charge = 0.5
    until(lambda: (one := statuses.take()) is not None and one.on_hold, ANSWER_S, "not on hold")
    assert queue.task("round").state == "queued"
    robot.charge = 0.9
    queue.wait("round", "succeeded")
    assert mission(bus, "status").step < 60, "it went on from where it was"


def test_a_planner_that_is_away_leaves_tasks_waiting(
    queue: Queue, planner: subprocess.Popen[bytes], bus: Bus
):
    """The last test of this file: no planner is there afterwards."""
    planner.kill()
    planner.wait()
    statuses = bus.subscribe(QUEUE, robot="r1")
    queue.add("waits")
    why = "nothing is heard of the planner"
    until(lambda: (one := statuses.take()) is not None and one.why == why, ANSWER_S, "not said")
    assert queue.task("waits").state == "queued"
