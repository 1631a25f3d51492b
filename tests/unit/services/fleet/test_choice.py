"""Short ways first, and yet every task of a fleet gets its turn."""

from collections import Counter

import numpy as np
import pytest

from services.fleet.choice import Robot, choose
from services.fleet.condition import READY, Condition
from shared.messages.tasks import Task
from shared.transport.keys import ANY


def task(node: int, **fields) -> Task:
    return Task(
        **{"task_id": f"t-{node}", "robot": ANY, "kind": "goto", "map": "flat", "fleet": True} | fields
    )


DRIVES = Condition("kept", "mission t-7 is running")


def robot(name: str, node: int, at: str = "flat", condition: Condition = READY) -> Robot:
    return Robot(name, condition, map=at, node=node)


def at_work(name: str) -> Robot:
    return robot(name, 20, condition=DRIVES)


def along_a_line(asked: Task, one: Robot) -> float:
    """A task begins at the node that its id names; nodes stand a metre apart."""
    assert one.node is not None
    return abs(one.node - int(asked.task_id.partition("-")[2]))


def chosen(waiting, free, busy=(), overtaken=None):
    moves = choose(waiting, free, [*free, *busy], {one.name for one in busy}, along_a_line, overtaken or {})
    return [(move.task.task_id, move.to, move.overtaken) for move in moves]


def test_the_shortest_way_goes_first():
    free = [robot("r1", 9), robot("r2", 0)]
    assert chosen([task(8), task(9)], free) == [("t-9", "r1", ("t-8",)), ("t-8", "r2", ())]


def test_as_many_tasks_compete_as_robots_share_the_map():
    waiting = [task(50), task(40), task(30), task(1)]
    busy = [at_work("r2"), at_work("r3")]
    assert chosen(waiting, [robot("r1", 0)], busy) == [("t-30", "r1", ("t-50", "t-40"))]
    elsewhere = [robot("r2", 20, at="loft"), robot("r3", 20, condition=Condition("silent", "gone"))]
    assert chosen(waiting, [robot("r1", 0)], elsewhere) == [("t-50", "r1", ())]


def test_who_drives_something_else_shares_no_tasks():
    others, alone = [at_work("r2"), at_work("r3")], robot("r1", 0)
    moves = choose([task(50), task(1)], [alone], [alone, *others], (), along_a_line, {})
    assert [(move.task.task_id, move.to) for move in moves] == [("t-50", "r1")]


def test_nothing_overtakes_a_task_more_often_than_there_are_other_robots():
    waiting, busy = [task(50), task(2), task(1)], [at_work("r2"), at_work("r3")]
    assert chosen(waiting, [robot("r1", 0)], busy, {"t-50": 1}) == [("t-1", "r1", ("t-50", "t-2"))]
    assert chosen(waiting, [robot("r1", 0)], busy, {"t-50": 2}) == [("t-50", "r1", ())]
    assert chosen(waiting, [robot("r1", 0)], busy, {"t-2": 2}) == [("t-2", "r1", ("t-50",))]


def test_what_is_urgent_is_not_overtaken_by_what_is_near():
    waiting = [task(50, priority=6), task(1), task(30)]
    free = [robot("r1", 0), robot("r2", 29)]
    assert chosen(waiting, free) == [("t-50", "r2", ()), ("t-1", "r1", ())]


def test_maps_do_not_compete():
    waiting = [task(50), task(1, map="loft"), task(40)]
    free = [robot("r1", 49), robot("r2", 0, at="loft")]
    assert chosen(waiting, free) == [("t-50", "r1", ()), ("t-1", "r2", ())]


@pytest.mark.parametrize("robots", [1, 2, 4])
def test_in_a_queue_that_never_ends_each_task_is_overtaken_a_few_times_at_most(robots: int):
    rng, overtaken, most = np.random.default_rng(1), Counter(), 0
    fleet = [robot(f"r{number}", 0) for number in range(robots)]
    waiting = [task(1000), *(task(node) for node in range(2, 12))]
    for number in range(100):
        who = fleet[int(rng.integers(robots))]
        (move,) = choose(waiting, [who], fleet, (), along_a_line, overtaken)
        waiting.remove(move.task)
        overtaken.update(move.overtaken)
        most = max(most, overtaken[move.task.task_id])
        waiting.append(task(int(rng.integers(20, 900)), task_id=f"t{number}-{rng.integers(20, 900)}"))
    assert "t-1000" not in {one.task_id for one in waiting}
    assert most == robots - 1
