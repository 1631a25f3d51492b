"""What the robot's other services said lately: mission, emergency stop, driver, battery."""

from shared.bus import Bus
from shared.robots.seen import Seen
from shared.topics import BATTERY, ESTOP_STATE, MANUAL, STATUS

LATELY_S = 5.0
"""Planner and drive repeat what they say once a second; chosen: five of them lost."""
HANDS_S = 2.0
"""A person who drives says so many times a second; chosen."""


class Hearing:
    """Keeps the newest of each for as long as it counts."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._statuses = bus.subscribe(STATUS, robot=robot)
        self._stops = bus.subscribe(ESTOP_STATE, robot=robot)
        self._wishes = bus.subscribe(MANUAL, robot=robot)
        self._batteries = bus.subscribe(BATTERY, robot=robot)
        self._seen = Seen(None, None)
        self._status_s = self._stop_s = self._driver_s = float("-inf")

    def listen(self, now_s: float) -> Seen:
        """Take what came; `now_s` is monotonic."""
        seen = self._seen
        status, stopped, driver, charge = seen.status, seen.stopped, seen.driver, seen.charge
        for told in self._statuses.take_all():
            if status is None or told.epoch >= status.epoch:  # not one of a planner that was replaced
                status, self._status_s = told, now_s
        for state in self._stops.take_all():
            stopped, self._stop_s = state.engaged, now_s
        for wish in self._wishes.take_all():
            driver, self._driver_s = (wish.who or "somebody") if wish.action == "drive" else "", now_s
        for battery in self._batteries.take_all():
            charge = battery.share
        if now_s - self._status_s > LATELY_S:
            status = None
        if now_s - self._stop_s > LATELY_S:
            stopped = None
        if now_s - self._driver_s > HANDS_S:
            driver = ""
        self._seen = Seen(status, stopped, driver, charge)
        return self._seen
