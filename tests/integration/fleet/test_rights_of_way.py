"""Robots in one corridor, over the bus: who comes second waits, a dead one is in nobody's way for long."""

import time

from shared.bus import Bus, Inbox
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.tasks import Task
from shared.topics import MISSION, STATUS
from tests.integration.dispatch.robot import until
from tests.integration.fleet.conftest import ANSWER_S, ROOM, FleetQueue
from tests.integration.fleet.robots import FleetRobot

FREED_S = 5.0
"""A leg on which a robot was killed is free again by then."""
NEVER = 1000


def walk(queue: FleetQueue, robot: str, way: list[int], frames: int) -> None:
    """Have a robot go along a way."""
    about = {"task_id": f"walk-{robot}-{way[0]}", "robot": robot, "kind": "walk", "map": "flat"}
    task = Task.model_validate({**about, "parameters": {"way": way, "frames": frames}})
    queue.ask("add", robot, task=task)


class Told:
    """What a robot says of itself."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._statuses: Inbox[MissionStatus] = bus.subscribe(STATUS, robot=robot)
        self.last = MissionStatus(robot=robot)

    def is_at(self, node: int) -> bool:
        """Whether it is at a node, by its last word."""
        self.last = [self.last, *self._statuses.take_all()][-1]
        return self.last.nearest_node == node and self.last.action == "walk"


def test_one_with_nothing_to_do_is_sent_into_a_room_before_another_comes(
    robots: dict[str, FleetRobot], queue: FleetQueue, bus: Bus
):
    assert robots.keys() >= {"r1", "r2"}
    second = Told(bus, "r2")
    walk(queue, "r2", [11, 10], frames=1)
    until(lambda: second.is_at(10) and second.last.state == "succeeded", ANSWER_S, "r2 is not there")
    walk(queue, "r1", [*range(1, 18)], frames=NEVER)

    def sent() -> list[Task]:
        reply = queue.ask("read", "r2", ended=20)
        return [task for task in (*reply.tasks, *reply.ended) if task.by == "fleet" and not task.fleet]

    until(sent, ANSWER_S, "nobody sends r2 away")
    task = sent()[-1]
    assert task.parameters["goal_node"] in ROOM[2:]
    assert (task.kind, task.map, task.priority) == ("goto", "flat", 9)
    bus.ask(MISSION, MissionRequest(action="cancel"), ANSWER_S, robot="r1")


def test_a_leg_is_granted_to_one_and_is_free_soon_after_that_one_was_killed(
    robots: dict[str, FleetRobot], queue: FleetQueue, bus: Bus
):
    first, second = Told(bus, "r1"), Told(bus, "r2")
    walk(queue, "r1", [*range(7)], frames=5)
    until(lambda: first.is_at(3), ANSWER_S, f"r1 does not get on: {first.last}")
    walk(queue, "r2", [*range(10, 1, -1)], frames=1)
    until(lambda: second.is_at(8), ANSWER_S, f"r2 does not get on: {second.last}")
    until(lambda: second.is_at(8) and "taken by r1" in second.last.reason, ANSWER_S, "r2 does not wait")
    robots.pop("r1").kill()
    killed_s = time.monotonic()
    until(lambda: not second.is_at(8), ANSWER_S, "r2 waits for a dead robot")
    assert time.monotonic() - killed_s < FREED_S
    until(lambda: second.is_at(2), ANSWER_S, f"r2 does not get on: {second.last}")
