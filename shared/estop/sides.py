"""The two sides of the emergency stop on the bus: drive decides and tells, the robot follows and answers."""

import logging
import time
from pathlib import Path

from shared.bus import Bus, Publisher, Request
from shared.estop.latch import Latch
from shared.messages.estop import EStopRequest, EStopState
from shared.topics import ESTOP, ESTOP_STATE, ROBOT_ESTOP_STATE

log = logging.getLogger(__name__)

HEARTBEAT_S = 1.0
"""Both sides repeat their state: who was away, or lost a message, knows it so much later (decision 0019)."""


class EStopServer:
    """Drive's side: answers requests, never asks who sends them, and tells everybody."""

    def __init__(self, bus: Bus, robot: str, folder: Path) -> None:
        self._latch = Latch(robot, folder)
        self._requests = bus.requests(ESTOP, robot=robot)
        self._robot_states = bus.subscribe(ROBOT_ESTOP_STATE, robot=robot)
        self._told = _RepeatedState(bus.publisher(ESTOP_STATE, robot=robot))
        self._kept = _KeptState(self._latch)

    @property
    def state(self) -> EStopState:
        """How it stands now."""
        return self._latch.state

    def step(self, now_s: float) -> None:
        """Read what came; `now_s` is monotonic."""
        while (request := self._requests.take()) is not None:
            self._answer(request, now_s)
        robots = self._robot_states.take()
        if robots is not None and self._latch.learn(robots):
            self._told.publish(self.state, now_s)
        self._kept.keep(now_s)
        self._told.repeat(self.state, now_s)

    def _answer(self, request: Request[EStopRequest, EStopState], now_s: float) -> None:
        """The robot hears of a stop before the disk does: writing takes longer than braking may."""
        wish = request.message
        try:
            if wish.action == "engage":
                self._latch.engage(wish.who, wish.why, time.time_ns())
                self._told.publish(self.state, now_s)
                self._latch.save()
                log.warning("emergency stop by %r: %s", wish.who, wish.why)
            elif wish.action == "clear":
                self._latch.clear(wish.who, wish.why, time.time_ns())
                self._told.publish(self.state, now_s)
                log.warning("emergency stop cleared by %r: %s", wish.who, wish.why)
        except ValueError as error:
            request.refuse(str(error))
        except OSError as error:
            log.error("emergency stop not saved: %s", error)
            stands = "engaged" if self.state.engaged else "clear"
            request.refuse(
                f"{stands}, but it cannot be saved and would not outlive the drive service: {error}"
            )
        else:
            request.reply(self.state)


class RobotEStop:
    """The robot's side: holds what it heard or kept, and says so."""

    def __init__(self, bus: Bus, robot: str, folder: Path) -> None:
        self._latch = Latch(robot, folder)
        self._drive_states = bus.subscribe(ESTOP_STATE, robot=robot)
        self._told = _RepeatedState(bus.publisher(ROBOT_ESTOP_STATE, robot=robot))
        self._kept = _KeptState(self._latch)
        self._changed = False

    def engaged(self) -> bool:
        """Read what came; whether the wheels must stand now."""
        drives = self._drive_states.take()
        if drives is not None and self._latch.follow(drives):
            state = self._latch.state
            log.warning("emergency stop %s by %r", "engaged" if state.engaged else "cleared", state.who)
            self._changed = True
        return self._latch.state.engaged

    def tell(self, now_s: float) -> None:
        """Keep what was read and say so. Call it after the wheels: a disk may be slower than brakes may."""
        self._kept.keep(now_s)
        if self._changed:
            self._changed = False
            self._told.publish(self._latch.state, now_s)
        self._told.repeat(self._latch.state, now_s)


class _RepeatedState:
    """Publishes a state when it changes and every heartbeat."""

    def __init__(self, publisher: Publisher[EStopState]) -> None:
        self._publisher = publisher
        self._published_s = float("-inf")

    def publish(self, state: EStopState, now_s: float) -> None:
        self._publisher.put(state)
        self._published_s = now_s

    def repeat(self, state: EStopState, now_s: float) -> None:
        if now_s - self._published_s >= HEARTBEAT_S:
            self.publish(state, now_s)


class _KeptState:
    """Saves a state, and one that could not be saved once more every heartbeat, until it is.

    What was heard holds meanwhile: the other side has it too.
    """

    def __init__(self, latch: Latch) -> None:
        self._latch = latch
        self._failed: tuple[EStopState, float] | None = None

    def keep(self, now_s: float) -> None:
        """Save what is not saved yet."""
        failed = self._failed
        if failed is not None and failed[0] == self._latch.state and now_s - failed[1] < HEARTBEAT_S:
            return
        try:
            self._latch.save()
        except OSError as error:
            log.error("emergency stop not saved, tried again in %g s: %s", HEARTBEAT_S, error)
            self._failed = self._latch.state, now_s
        else:
            self._failed = None
