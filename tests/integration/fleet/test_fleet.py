"""Twelve tasks for three robots: the nearest gets each, one robot dies amid, and each task is done once."""

from collections import Counter
from pathlib import Path

from shared.bus import Bus
from shared.messages.tasks import QueueStatus
from shared.topics import FLEET_QUEUE
from shared.transport.keys import ANY
from tests.integration.dispatch.robot import until
from tests.integration.fleet.conftest import ANSWER_S, FleetQueue
from tests.integration.fleet.robots import FleetRobot

LONG, SHORT = 40, 2
"""Frames of a task, ten a second: what is long still runs when the next has been handed out."""
FIRST = {"near-r3": 18, "near-r1": 1, "near-r2": 12}
LATER = {f"later-{number}": 2 * number for number in range(8)}


def until_looked(bus: Bus, times: int, why: str = "", **expected: object) -> QueueStatus:
    """Wait until the fleet service has looked at its queue so often and says this of it; `why` in part."""
    statuses = bus.subscribe(FLEET_QUEUE)
    told: list[QueueStatus] = []

    def says() -> bool:
        told.extend(statuses.take_all())
        return (
            len(told) >= times
            and why in told[-1].why
            and all(getattr(told[-1], n) == value for n, value in expected.items())
        )

    until(says, ANSWER_S, f"it says {told[-1:]}")
    return told[-1]


def until_is(queue: FleetQueue, task_id: str, state: str) -> str:
    """Wait until a task is in a state; the robot that has it."""
    until(lambda: queue.task(task_id).state == state, ANSWER_S, f"{task_id} is not {state}")
    return queue.task(task_id).robot


def test_each_task_is_done_once_by_the_nearest_and_by_another_where_that_one_dies(
    robots: dict[str, FleetRobot], queue: FleetQueue, bus: Bus, begun: Path
):
    until_looked(bus, 12)  # two seconds: longer than a robot takes to say that it has nothing to do
    for task_id, node in FIRST.items():
        queue.add(task_id, node, frames=LONG if task_id != "near-r2" else SHORT, file=str(begun))
    assert {task_id: until_is(queue, task_id, "succeeded") for task_id in FIRST} == {
        "near-r1": "r1",
        "near-r2": "r2",
        "near-r3": "r3",
    }
    until_looked(bus, 12)
    robots.pop("r2").kill()
    queue.add("left", 12, frames=SHORT, file=str(begun))
    until(lambda: queue.task("left").robot == "r2", ANSWER_S, "the fleet does not take r2 for free")
    for task_id, node in LATER.items():
        queue.add(task_id, node, frames=SHORT, file=str(begun))
    names = [*FIRST, "left", *LATER]
    doers = {task_id: until_is(queue, task_id, "succeeded") for task_id in names}
    assert doers["left"] in ("r1", "r3")
    assert {doers[task_id] for task_id in LATER} == {"r1", "r3"}
    assert len(names) == len(set(names)) == 12
    assert Counter(begun.read_text(encoding="utf-8").split()) == dict.fromkeys(names, 1)
    assert until_looked(bus, 1, waiting=0).robot == ANY


def test_a_task_that_no_robot_is_free_for_waits_and_says_why(queue: FleetQueue, bus: Bus):
    queue.add("alone", 3)
    until_looked(bus, 1, why="r1: nothing is heard of its ", waiting=1)
    assert queue.task("alone").robot == ANY
    queue.ask("cancel", task_id="alone")
