"""Rights of way among the robots of one map, asked of the fleet service; where none is, all is free."""

import logging
import time
from collections.abc import Sequence

from services.planner.ports import RightOfWay
from shared.bus import Bus
from shared.messages.traffic import WayRequest
from shared.queries import QueryError
from shared.topics import WAY

log = logging.getLogger(__name__)

RENEWED_S = 1.0
"""A claim is said again after so long, also by a robot that stands; a lease lasts four times as long."""
MISSED_S = 10.0
"""So long after the fleet service went away nobody goes on: it is back in a second, unless somebody took it
away for good; chosen."""
UNHEARD = "nobody answers who may drive where: is the fleet service up?"


class Traffic:
    """Speaks for one robot.

    Args:
        bus: to the fleet service.
        robot: its name.
        timeout_s: for an answer.
    """

    def __init__(self, bus: Bus, robot: str, timeout_s: float) -> None:
        self._bus, self._robot, self._timeout_s = bus, robot, timeout_s
        self._fleets: set[str] = set()
        self._seen_s = self._asked_s = float("-inf")
        self._said: WayRequest | None = None
        bus.watch_alive(self._note, "fleet")

    def ask(self, name: str, at: Sequence[int], ahead: Sequence[int], *, busy: bool = True) -> RightOfWay:
        """How far a robot may go along its way.

        Args:
            name: of the map.
            at: nodes between which it is.
            ahead: nodes of its way beyond.
            busy: whether it is on a mission.
        """
        if not self.is_regulated:
            return RightOfWay(len(ahead))
        if not self._fleets:
            return RightOfWay(0, UNHEARD)
        request = WayRequest(robot=self._robot, map=name, at=tuple(at), ahead=tuple(ahead), busy=busy)
        self._asked_s = self._seen_s = time.monotonic()
        self._said = request
        try:
            reply = self._bus.ask(WAY, request, self._timeout_s, robot=self._robot)
        except QueryError as error:
            self._bus.counters.count("no right of way", str(error))
            return RightOfWay(0, UNHEARD)
        return RightOfWay(reply.free, reply.why, reply.room)

    @property
    def is_regulated(self) -> bool:
        """Whether there is somebody to ask, or was so lately that he is to be waited for."""
        return bool(self._fleets) or time.monotonic() - self._seen_s < MISSED_S

    def renew(self, name: str, at: Sequence[int], *, busy: bool, drives: bool) -> None:
        """Say where the robot is, if nothing was said for a while.

        Args:
            name: of the map.
            at: the node at which it stands, if anybody knows.
            busy: whether it is on a mission.
            drives: whether that goes on, so that it may be on a leg that it was granted.
        """
        if not self._fleets or time.monotonic() - self._asked_s < RENEWED_S:
            return
        said = self._said
        if drives and said is not None and said.busy and said.map == name:
            self.ask(name, said.at, said.ahead)
        else:
            self.ask(name, at, (), busy=busy)

    def _note(self, _service: str, instance: str, alive: bool) -> None:
        """On Zenoh's thread: a fleet service came or went."""
        self._fleets = self._fleets | {instance} if alive else self._fleets - {instance}
