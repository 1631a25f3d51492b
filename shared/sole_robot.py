"""One process per robot name: of two that call themselves the same, the one that was there first is it."""

import logging
import threading
import time
import uuid

from shared.bus import Bus
from shared.transport.keys import robot_key

log = logging.getLogger(__name__)


class TakenError(RuntimeError):
    """Another process is this robot; the text says what to do."""


class SoleRobot:
    """Says on the bus that this process is robot `robot`, and notices when another one says so too.

    A holder's name begins with the time of its start, so that both sides agree who was first. A process that
    was killed is forgotten at once, one that hangs or was cut off after the bus's lease.
    """

    def __init__(self, bus: Bus, robot: str) -> None:
        self._robot, self._me = robot, f"{time.time_ns():020d}-{uuid.uuid4().hex[:8]}"
        self._others: set[str] = set()
        self._lock = threading.Lock()
        bus.watch_tokens(robot_key(robot, "*"), self._changed)
        bus.declare_token(robot_key(robot, self._me))

    def require(self) -> None:
        """Do nothing while this process is the robot.

        Raises:
            TakenError: another one is, and has been for longer.
        """
        with self._lock:
            first = min(self._others, default=self._me)
        if first < self._me:
            raise TakenError(
                f"robot {self._robot!r} is driven by another process already (holder {first}): "
                "stop that one, or give this one another name (TOPNAV_ROBOT)"
            )

    def _changed(self, key: str, alive: bool) -> None:
        holder = key.rpartition("/")[2]
        if holder == self._me:
            return
        with self._lock:
            (self._others.add if alive else self._others.discard)(holder)
        if alive:
            log.error("alarm: another process calls itself robot %r (holder %s)", self._robot, holder)
