"""One robot as its services tell of it, and since when it stands as it does."""

from services.fleet.choice import Robot
from services.fleet.condition import Condition, condition_of
from shared.bus import Bus
from shared.messages.missions import MissionStatus
from shared.messages.tasks import QueueStatus
from shared.robots.hearing import LATELY_S, Hearing
from shared.topics import QUEUE


class Watched:
    """Listens to one robot. What it remembers is how long something lasts, and a restart begins that anew.

    Args:
        now_s: monotonic, from when on it listens: before that nobody has been silent.
    """

    def __init__(self, bus: Bus, name: str, now_s: float) -> None:
        self.name = name
        self._hearing = Hearing(bus, name)
        self._queues = bus.subscribe(QUEUE, robot=name)
        self._told: QueueStatus | None = None
        self._told_s = float("-inf")
        self._condition, self._since_s = Condition("silent", "nothing is heard of it yet"), now_s
        self._map = ""
        self._node: int | None = None

    def look(self, now_s: float, battery: float) -> Robot:
        """The robot as it is now; `now_s` is monotonic, `battery` the least charge with which it begins."""
        seen = self._hearing.listen(now_s)
        for told in self._queues.take_all():
            self._told, self._told_s = told, now_s
        said = self._told if now_s - self._told_s <= LATELY_S else None
        condition = condition_of(seen, said, battery)
        if condition.kind != self._condition.kind:
            self._since_s = now_s
        self._condition = condition
        status = seen.status
        if status is not None and status.mission_id:
            self._follow(status)
        has_tasks = said is not None and bool(said.waiting or said.running)
        return Robot(self.name, condition, now_s - self._since_s, self._map, self._node, has_tasks)

    def _follow(self, status: MissionStatus) -> None:
        """Who has arrived at a picture, or looks for its way, names no node: it is near the last one."""
        if status.map != self._map:
            self._map, self._node = status.map, None
        if status.nearest_node is not None:
            self._node = status.nearest_node
