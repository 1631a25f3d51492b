"""Fleet loop: looks at the fleet's queue and at all robots, and hands tasks over and takes them back."""

import logging
import math
import threading
import time
import uuid
from collections import Counter
from collections.abc import Callable

from services.fleet.beginnings import first_node
from services.fleet.choice import Move, Robot
from services.fleet.core import Plan, decide
from services.fleet.maps import Maps
from services.fleet.settings import FleetSettings
from services.fleet.traffic.desk import Desk
from services.fleet.traffic.rights import Claim
from services.fleet.watching import Watched
from shared.bus import Bus
from shared.lifecycle import in_thread
from shared.messages.tasks import QueueStatus, Task, TaskReply, TaskRequest
from shared.queries import QueryError, RefusedError
from shared.topics import FLEET_QUEUE, STATUS, TASKS
from shared.transport.keys import ANY, is_robot
from shared.wire import WireError

log = logging.getLogger(__name__)

FIRST = 9
"""Priority of a task that clears the way: nothing else begins before it."""
LISTENS_S = 2.5
"""Before it hands out anything: planner, drive and dispatch say once a second how they stand; who was heard
first would get what another one is nearer to."""


class Fleet:
    """Gives the tasks for whichever robot to robots. Holds nothing that a restart would need.

    It counts how often tasks were overtaken; a restart lets them be overtaken as often again.

    Args:
        to_send: robots with nothing to do that stand in the way of others, by the time now.
    """

    def __init__(self, settings: FleetSettings, bus: Bus, to_send: Callable[[float], list[Claim]]) -> None:
        self._settings, self._bus, self._to_send = settings, bus, to_send
        self._limits = settings.limits()
        self._maps = Maps(bus, settings.map_period_s, settings.query_timeout_s)
        self._heard = bus.subscribe(STATUS, robot="*")
        self._statuses = bus.publisher(FLEET_QUEUE)
        self._robots: dict[str, Watched] = {}
        self._began_s: float | None = None
        self._count, self._alarm = 0, ""
        self._sent: dict[str, float] = {}
        self._overtaken: Counter[str] = Counter()

    def step(self, now_s: float) -> None:
        """Do what there is to do; `now_s` is monotonic.

        Raises:
            QueryError, WireError: the map store does not answer as it should.
        """
        self._maps.follow()
        self._began_s = now_s if self._began_s is None else self._began_s
        names = {status.robot for status in self._heard.take_all()}
        queue = self._ask(ANY, TaskRequest(action="read"))
        names |= {task.robot for task in queue.tasks} - {ANY}
        for name in sorted(names - self._robots.keys()):
            if is_robot(name) and len(self._robots) < self._settings.max_robots:
                self._robots[name] = Watched(self._bus, name, now_s)
        robots = [watched.look(now_s, self._limits.battery) for watched in self._robots.values()]
        waiting = {task.task_id for task in queue.tasks if task.robot == ANY}
        self._overtaken = Counter({one: count for one, count in self._overtaken.items() if one in waiting})
        plan = decide(
            queue.tasks,
            robots,
            lambda task, robot: self._way_m(task, robot, now_s),
            self._limits,
            self._overtaken,
        )
        self._tell(queue, plan)
        for move in plan.moves if now_s - self._began_s >= LISTENS_S else ():
            self._move(move)
        for claim in self._to_send(now_s):
            self._send_away(claim)

    def _way_m(self, task: Task, robot: Robot, now_s: float) -> float:
        """Metres from where a robot is to where a task begins; infinite where nobody knows."""
        node = first_node(task, self._maps.graph(task.map, now_s))
        if node is None or robot.node is None:
            return math.inf
        return self._maps.metres_to(task.map, node, now_s).get(robot.node, math.inf)

    def _move(self, move: Move) -> None:
        """Hand over or take back. Refused is what changed meanwhile: the next look sees how it is."""
        task = move.task
        wish = TaskRequest(action="move", task_id=task.task_id, to=move.to)
        try:
            self._ask(task.robot, wish)
        except RefusedError as error:
            self._bus.counters.count("not moved", str(error))
        else:
            self._overtaken.update(move.overtaken)
            log.info("task %s: from %s to %s, %s", task.task_id, task.robot, move.to, move.why)

    def _send_away(self, claim: Claim) -> None:
        """Have a robot with nothing to do that stands in the way of others go elsewhere, before all else."""
        if self._sent.get(claim.robot) == claim.told_s:
            return
        task = Task(
            task_id=f"room-{uuid.uuid4().hex[:16]}",
            robot=claim.robot,
            kind="goto",
            map=claim.map,
            parameters={"goal_node": claim.room[-1]},
            priority=FIRST,
            by="fleet",
        )
        self._ask(claim.robot, TaskRequest(action="add", task=task))
        self._sent[claim.robot] = claim.told_s
        log.info("%s is in the way of others: to node %d", claim.robot, claim.room[-1])

    def _tell(self, queue: TaskReply, plan: Plan) -> None:
        alarm = plan.alarm
        if queue.damaged and not alarm:
            alarm = f"{queue.damaged} records of tasks are damaged: see 'topnav map check'"
        if alarm and alarm != self._alarm:
            log.error("alarm: %s", alarm)
        self._alarm = alarm
        self._count += 1
        waiting = sum(task.state == "queued" for task in queue.tasks)
        self._statuses.put(
            QueueStatus(seq=self._count, robot=ANY, waiting=waiting, why=plan.why, alarm=alarm)
        )

    def _ask(self, queue: str, request: TaskRequest) -> TaskReply:
        return self._bus.ask(TASKS, request, self._settings.query_timeout_s, queue=queue)


def run(settings: FleetSettings, bus: Bus, stop: threading.Event) -> None:
    """Look at the queue once a period until `stop`; who is away is waited for."""
    desk = Desk(bus, settings.map_period_s, settings.query_timeout_s)
    fleet = Fleet(settings, bus, desk.to_send)
    desk.announce()
    with in_thread(desk.serve, "rights of way") as check:
        while not stop.wait(settings.period_s):
            check()  # robots would wait for a desk that is gone while this process is there
            try:
                fleet.step(time.monotonic())
            except (QueryError, WireError) as error:
                bus.counters.count("unanswered", str(error))
