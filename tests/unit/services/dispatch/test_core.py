"""What is done next about the tasks of a robot, for every state it can be in."""

import pytest

from services.dispatch.core import Limits, Step, next_step
from shared.messages.missions import MissionStatus
from shared.messages.tasks import Task, TaskReply
from shared.robots.seen import Seen

LIMITS = Limits(low=0.2, resume=0.8)


def task(task_id: str, state: str = "queued", **fields) -> Task:
    return Task(task_id=task_id, robot="r1", kind="wave", map="flat", state=state, **fields)


def queue(*tasks: Task, **fields) -> TaskReply:
    """As the map store answers: in order, what runs first."""
    return TaskReply(robot="r1", tasks=tasks, **fields)


def status(state: str = "idle", mission_id: str = "", **fields) -> MissionStatus:
    return MissionStatus(robot="r1", state=state, mission_id=mission_id, **fields)


def seen(state: str = "idle", mission_id: str = "", stopped: bool | None = False, **fields) -> Seen:
    """A robot whose planner says this and that otherwise is free to go."""
    paused = {"paused_by": fields.pop("paused_by", "")}
    return Seen(status(state, mission_id, **paused), stopped, **fields)


def step(tasks: TaskReply, robot: Seen) -> tuple[str, str]:
    """What is done, and about which task."""
    found = next_step(tasks, robot, LIMITS)
    return found.action, found.task.task_id if found.task else ""


WAITING = queue(task("a"), task("b"))
RUNNING = queue(task("a", "running"), task("b"))


@pytest.mark.parametrize("state", ["idle", "succeeded", "failed", "cancelled"])
def test_the_first_task_begins_when_the_planner_has_none(state: str):
    assert step(WAITING, seen(state, "m-0")) == ("begin", "a")


@pytest.mark.parametrize(
    ("robot", "why"),
    [
        (Seen(None, False), "nothing is heard of the planner"),
        (seen(stopped=None), "nothing is heard of drive"),
        (seen(stopped=True), "the emergency stop is engaged"),
        (seen(driver="anna"), "anna drives by hand"),
        (seen("running", "m-0"), "mission m-0 is running"),
        (seen("paused", "m-0"), "mission m-0 is paused"),
    ],
)
def test_nothing_begins_and_the_reason_is_said(robot: Seen, why: str):
    assert next_step(WAITING, robot, LIMITS) == Step(why=why)


def test_an_empty_queue_waits_for_nothing():
    assert next_step(queue(), seen(stopped=True), LIMITS) == Step()


def test_while_a_task_runs_no_other_begins():
    assert step(RUNNING, seen("running", "a")) == ("wait", "")


def test_a_task_whose_end_is_not_on_record_yet_is_waited_for_and_not_begun_again():
    assert step(RUNNING, seen("succeeded", "a")) == ("wait", "")


def test_a_task_that_is_on_record_and_unknown_to_the_planner_is_asked_for_again():
    assert step(RUNNING, seen("idle")) == ("begin", "a")
    assert step(RUNNING, seen("succeeded", "m-0")) == ("begin", "a")


def test_a_task_goes_on_once_the_emergency_stop_that_paused_it_was_cleared():
    assert step(RUNNING, seen("paused", "a", paused_by="emergency_stop")) == ("resume", "a")


@pytest.mark.parametrize(
    "robot",
    [
        seen("paused", "a", stopped=True, paused_by="emergency_stop"),
        seen("paused", "a", stopped=None, paused_by="emergency_stop"),
        seen("paused", "a", driver="anna", paused_by="emergency_stop"),
        seen("paused", "a", paused_by="person"),
        seen("paused", "a", paused_by="by_hand"),
        seen("paused", "a"),
        seen("paused", "m-0", paused_by="emergency_stop"),
    ],
)
def test_a_mission_stays_paused_otherwise_and_where_it_is_no_task(robot: Seen):
    assert step(RUNNING, robot) == ("wait", "")


def test_a_low_battery_sends_the_robot_home_and_puts_the_running_task_back():
    low = seen("running", "a", charge=0.19)
    found = next_step(RUNNING, low, LIMITS)
    assert (found.action, found.task.kind, found.task.map) == ("go_home", "home", "flat")
    marked = queue(task("a", "running", put_back=True), task("home-1", for_battery=True))
    assert step(marked, low) == ("cancel", "a")
    put_back = queue(task("home-1", for_battery=True), task("a"))
    assert step(put_back, seen("cancelled", "a", charge=0.19)) == ("begin", "home-1")


def test_a_robot_on_its_way_home_goes_on():
    way = queue(task("home-1", "running", for_battery=True), task("a"))
    assert step(way, seen("running", "home-1", charge=0.1)) == ("wait", "")


def test_a_robot_without_a_task_is_left_alone_and_one_whose_tasks_wait_goes_home_first():
    assert step(queue(), seen(charge=0.1)) == ("wait", "")
    assert step(queue(), seen("running", "m-0", charge=0.1)) == ("wait", "")
    assert step(WAITING, seen(charge=0.1))[0] == "go_home"


def test_a_task_to_be_put_back_that_the_planner_does_not_know_lets_the_way_home_begin():
    marked = queue(task("a", "running", put_back=True), task("home-1", for_battery=True))
    assert step(marked, seen("idle", charge=0.1)) == ("begin", "home-1")


HOME = task("home-1", "succeeded", for_battery=True)


@pytest.mark.parametrize(
    ("charge", "holds"), [(0.1, True), (0.2, True), (0.79, True), (None, True), (0.8, False), (1.0, False)]
)
def test_at_home_the_queue_is_on_hold_until_the_battery_is_above_the_upper_limit(charge, holds):
    found = next_step(queue(task("a"), latest=HOME), seen("succeeded", "home-1", charge=charge), LIMITS)
    assert (found.action, found.on_hold) == (("wait", True) if holds else ("begin", False))


@pytest.mark.parametrize("charge", [0.2, 0.5, 0.79])
def test_between_the_limits_a_robot_that_has_not_gone_home_goes_on(charge: float):
    latest = task("z", "succeeded")
    assert step(queue(task("a"), latest=latest), seen(charge=charge)) == ("begin", "a")


def test_a_robot_that_did_not_get_home_is_an_alarm_and_begins_nothing_else():
    lost = task("home-1", "failed", for_battery=True, reason="the map has no place 'home'")
    found = next_step(queue(task("a"), latest=lost), seen(charge=0.1), LIMITS)
    assert (found.action, found.on_hold) == ("wait", True)
    assert found.alarm == "the battery is low and the robot did not get home: the map has no place 'home'"


def test_damaged_records_are_an_alarm():
    assert "2 records" in next_step(queue(damaged=2), seen(), LIMITS).alarm
