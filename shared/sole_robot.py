"""One process per robot name: of two that call themselves the same, the one that was there first is it."""

import logging
import threading
import time
import uuid

from shared.bus import Bus
from shared.queries import MEETING_S
from shared.transport.keys import robot_key

log = logging.getLogger(__name__)


class TakenError(RuntimeError):
    """Another process is this robot; the text says what to do."""


class SoleRobot:
    """Says on the bus that this process is robot `robot`, and notices when another one says so too.

    A holder's name begins with "running" once it is the robot, before that with "starting"; the least name
    wins. So who starts gives way to who runs, and the random rest decides only between two that have not
    heard of each other while they started. No clock has a say: that of another machine may be wrong.
    A process that was killed is forgotten at once, one that hangs or was cut off after the bus's lease.
    """

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot, self._id = bus, robot, uuid.uuid4().hex
        self._began_s = time.monotonic()
        self._others: set[str] = set()
        self._lock = threading.Lock()
        bus.watch_tokens(robot_key(robot, "*"), self._changed)
        self._say("starting")

    def claim(self) -> None:
        """Become the robot, once there was time to hear of others.

        Raises:
            TakenError: as for `require`.
        """
        time.sleep(max(0.0, self._began_s + MEETING_S - time.monotonic()))
        self.require()
        self._say("running")

    def require(self) -> None:
        """Do nothing while no other process comes first.

        Raises:
            TakenError: another one is the robot.
        """
        with self._lock:
            first = min(self._others, default=self._me)
        if first < self._me:
            raise TakenError(
                f"robot {self._robot!r} is driven by another process already (holder {first}): "
                "stop that one, or give this one another name (TOPNAV_ROBOT)"
            )

    def _say(self, stage: str) -> None:
        self._me = f"{stage}-{self._id}"
        self._bus.declare_token(robot_key(self._robot, self._me))

    def _changed(self, key: str, alive: bool) -> None:
        holder = key.rpartition("/")[2]
        if holder.endswith(self._id):
            return
        with self._lock:
            (self._others.add if alive else self._others.discard)(holder)
        if alive:
            log.error("alarm: another process calls itself robot %r (holder %s)", self._robot, holder)
