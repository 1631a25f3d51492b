"""A person's hand on the robot, from the shell: wishes that drive obeys within its limits."""

import time
from typing import Literal

from services.launcher.client.failure import ExperimentError
from shared.bus import Bus, wait_until
from shared.messages.drive import Manual, Velocity
from shared.topics import MANUAL, VELOCITY

PERIOD_S = 0.1
"""A wish holds for 0.4 s: of four one has to arrive."""
MEETING_S = 2.0
"""Before the first wish: the drive service has to be there to hear it."""


class Hand:
    """Moves one robot.

    Raises:
        ExperimentError: no drive service is there.
    """

    def __init__(self, bus: Bus, robot: str, who: str) -> None:
        drivers: set[str] = set()
        bus.watch_alive(lambda _service, instance, alive: drivers.add(instance) if alive else None, "drive")
        if not wait_until(lambda: bool(drivers), MEETING_S):
            raise ExperimentError("no drive service is there: see topnav status")
        self._robot, self._who = robot, who[:64]
        self._told, self._wishes = bus.subscribe(VELOCITY, robot=robot), bus.publisher(MANUAL, robot=robot)

    def move(self, forward_mps: float, left_mps: float, turn_radps: float, seconds: float) -> list[Velocity]:
        """Wish so for a while, then let go; returns what drive told the base for it."""
        answers: list[Velocity] = []
        self._told.take_all()
        until_s = time.monotonic() + seconds
        try:
            while (now_s := time.monotonic()) < until_s:
                self._say("drive", forward_mps, left_mps, turn_radps)
                time.sleep(min(PERIOD_S, until_s - now_s))
                answers += [one for one in self._told.take_all() if self._is_mine(one)]
        finally:
            self._say("release")
        return answers

    def _is_mine(self, velocity: Velocity) -> bool:
        return velocity.why == f"by hand: {self._who}"

    def _say(
        self,
        action: Literal["drive", "release"],
        forward_mps: float = 0.0,
        left_mps: float = 0.0,
        turn_radps: float = 0.0,
    ) -> None:
        now_ns = time.time_ns()
        self._wishes.put(
            Manual(
                seq=now_ns // 1_000_000, stamp_ns=now_ns, robot=self._robot, who=self._who, action=action,
                forward_mps=forward_mps, left_mps=left_mps, turn_radps=turn_radps,
            )
        )  # fmt: skip
