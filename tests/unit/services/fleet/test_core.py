"""Who gets which task of the fleet, for every state that robots can be in."""

import math

import pytest

from services.fleet.choice import Robot
from services.fleet.condition import READY, Condition
from services.fleet.core import Limits, decide
from shared.messages.tasks import Task
from shared.transport.keys import ANY

LIMITS = Limits(battery=0.3, silent_s=10.0, patience_s=60.0)
SILENT, LOW = Condition("silent", "nothing is heard of its planner"), Condition("low", "on hold")
KEPT = Condition("kept", "the emergency stop is engaged")


def task(task_id: str, robot: str = ANY, state: str = "queued", **fields) -> Task:
    return Task(task_id=task_id, robot=robot, kind="goto", map="flat", state=state, fleet=True, **fields)


def robot(name: str, node: int | None = 0, **fields) -> Robot:
    return Robot(**{"name": name, "condition": READY, "map": "flat", "node": node, **fields})


def along_a_line(asked: Task, one: Robot) -> float:
    """A task begins at the node that its id names; nodes stand a metre apart."""
    assert one.node is not None
    return abs(one.node - int(asked.task_id.partition("-")[2]))


def moves(tasks, robots):
    """What is moved where."""
    return [(move.task.task_id, move.to) for move in decide(tasks, robots, along_a_line, LIMITS, {}).moves]


def test_each_task_goes_to_the_nearest_free_robot_and_each_robot_gets_one():
    three = robot("r1", 0), robot("r2", 10), robot("r3", 20)
    tasks = [task("a-19"), task("b-11"), task("c-12"), task("d-1")]
    assert moves(tasks, three) == [("a-19", "r3"), ("b-11", "r2"), ("d-1", "r1")]


@pytest.mark.parametrize(
    "busy",
    [
        robot("r1", 0, condition=SILENT),
        robot("r1", 0, condition=LOW),
        robot("r1", 0, condition=KEPT),
        robot("r1", 0, has_tasks=True),
    ],
)
def test_one_that_cannot_begin_or_has_tasks_of_its_own_gets_none(busy: Robot):
    assert moves([task("a-1")], [busy, robot("r2", 9)]) == [("a-1", "r2")]
    assert moves([task("a-1")], [busy]) == []


@pytest.mark.parametrize("state", ["queued", "running"])
def test_one_that_has_a_task_of_the_fleet_gets_no_other(state: str):
    assert moves([task("z-1", "r1", state), task("a-1")], [robot("r1", 0)]) == []


def test_whose_whereabouts_nobody_knows_comes_last_and_then_by_name():
    strangers = robot("r1", None, map=""), robot("r2", None)
    assert moves([task("a-1")], [*strangers, robot("r3", 20)]) == [("a-1", "r3")]
    assert moves([task("a-1")], strangers) == [("a-1", "r1")]


def test_a_task_waits_for_the_robots_of_its_map_unless_there_are_none():
    elsewhere = robot("r1", 0, map="cellar")
    there = robot("r2", 3, condition=KEPT)
    assert moves([task("a-1")], [elsewhere, there]) == []
    assert moves([task("a-1")], [elsewhere, robot("r3", None, map="")]) == [("a-1", "r3")]
    assert moves([task("a-1")], [elsewhere]) == [("a-1", "r1")]
    assert moves([task("a-1")], [elsewhere, robot("r2", 3, condition=SILENT)]) == [("a-1", "r1")]


def test_the_way_is_asked_for_in_the_map_of_the_task_only():
    found = decide([task("a-1")], [robot("r1", 5, map="cellar")], lambda *_: pytest.fail("asked"), LIMITS, {})
    assert [move.to for move in found.moves] == ["r1"]


@pytest.mark.parametrize(
    ("condition", "lasts_s", "back"),
    [
        (READY, 1_000.0, False),
        (SILENT, 9.9, False),
        (SILENT, 10.0, True),
        (KEPT, 59.9, False),
        (KEPT, 60.0, True),
        (LOW, 0.0, True),
    ],
)
def test_what_waits_in_vain_comes_back_after_a_while(condition: Condition, lasts_s: float, back: bool):
    one = robot("r1", condition=condition, lasts_s=lasts_s)
    assert moves([task("a-1", "r1")], [one]) == ([("a-1", ANY)] if back else [])


@pytest.mark.parametrize("condition", [SILENT, LOW, KEPT])
def test_what_a_robot_has_begun_stays_with_it(condition: Condition):
    assert moves([task("a-1", "r1", "running")], [robot("r1", condition=condition, lasts_s=1e6)]) == []


def test_what_comes_back_is_given_away_at_the_next_look_and_not_to_a_robot_that_has_something():
    tasks = [task("a-1", "r1"), task("b-1", "r2")]
    robots = [robot("r1", condition=SILENT, lasts_s=99.0), robot("r2"), robot("r3", 50)]
    assert moves(tasks, robots) == [("a-1", ANY)]
    assert moves([task("a-1"), task("b-1", "r2")], robots) == [("a-1", "r3")]


def test_why_a_task_waits_is_said_by_robot():
    robots = [robot("r1", condition=KEPT), robot("r2", has_tasks=True)]
    why = decide([task("a-1")], robots, along_a_line, LIMITS, {}).why
    assert why == "r1: the emergency stop is engaged; r2: has tasks"
    assert decide([task("a-1")], [], along_a_line, LIMITS, {}).why == "no robot is heard of"
    assert decide([task("a-1")], [robot("r1")], along_a_line, LIMITS, {}).why == ""
    assert decide([], robots, along_a_line, LIMITS, {}).why == ""


def test_a_robot_that_went_silent_with_a_task_is_an_alarm():
    gone = robot("r1", condition=SILENT, lasts_s=10.0)
    begun = [task("a-1", "r1", "running")]
    assert "a-1 by r1" in decide(begun, [gone], along_a_line, LIMITS, {}).alarm
    assert decide(begun, [robot("r1", condition=SILENT, lasts_s=9.0)], along_a_line, LIMITS, {}).alarm == ""
    assert decide([task("a-1", "r1")], [gone], along_a_line, LIMITS, {}).alarm == ""


def test_a_move_says_how_far_it_is():
    near, far = decide(
        [task("a-3"), task("b-3")], [robot("r1", 0), robot("r2", None)], along_a_line, LIMITS, {}
    ).moves
    assert (near.why, far.why) == ("3.0 m away", "the way there is not known")
    unreachable = decide([task("a-3")], [robot("r1", 0)], lambda *_: math.inf, LIMITS, {}).moves
    assert unreachable[0].why == "the way there is not known"
