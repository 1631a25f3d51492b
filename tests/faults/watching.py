"""Watching the wheels and the messages of a robot while something is killed."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

from experiments.bench.listener import Background
from services.launcher.client.experimenter import Experimenter
from services.launcher.client.stack import Stack
from shared.bus import Bus, open_bus, wait_until
from shared.messages.drive import Heading, Velocity
from shared.messages.missions import MissionRequest, MissionStatus
from shared.queries import QueryError
from shared.topics import FEATURES, HEADING, MISSION, TRUTH, VELOCITY

TOPICS = {"truth": TRUTH, "features": FEATURES, "planner": HEADING, "drive": VELOCITY}
MOVING_MPS = 0.1
STILL_MPS = 0.03
ASK_S = 30.0
MOVES_S = 90.0
HELD_UP_S = 0.3
"""A watcher turns every fifth of a second at least: one that missed this long was held up itself."""

TRIES = 3
"""Where a service is held up by what else runs here, the wheels stand that much later: the best of so many
counts. What is broken is late every time."""


def ask(stack: Stack, **request: Any) -> MissionStatus:
    """Ask the planner of a stack."""
    return stack.bus.ask(MISSION, MissionRequest(**request), ASK_S, robot=stack.robot)


def ended(stack: Stack) -> bool:
    """End the mission, if there is one; False where the planner is not there to be asked: ask again."""
    try:
        if ask(stack, action="status").state in ("running", "paused"):
            ask(stack, action="cancel")
    except QueryError:
        return False
    return True


@contextmanager
def exploring(stack: Stack, map_name: str, back_s: float) -> Iterator["Watch"]:
    """Watch a robot that explores and moves already; at the end its mission is ended, within `back_s`."""
    with Watch(stack.endpoint, stack.robot) as watching:
        set_off(stack, watching, map_name)
        yield watching
    assert wait_until(lambda: ended(stack), back_s, 0.2)


def set_off(stack: Stack, watching: "Watch", map_name: str) -> None:
    """Have the robot explore from the world's start; returns once it moves."""
    Experimenter(stack.bus, stack.robot).reset(1)
    began_s = time.monotonic()
    ask(stack, action="explore", map=map_name, seed=1)
    assert wait_until(lambda: watching.moving(began_s), MOVES_S)


def wall_ahead_s() -> float:
    """By how much the wall clock, which stamps messages, is ahead of the monotonic one."""
    found = []
    for _ in range(5):
        now_s = time.monotonic()
        found.append(time.time_ns() / 1e9 - now_s)
    return min(found)  # a pause between the two readings makes it larger


class Watch(Background):
    """Notes when each message arrived, and the true speed; a session and a thread of its own.

    Attributes:
        speeds: true speeds by the time of the state, which no delay on its way to here changes.
        frames: number of the newest frame at these times.
        held_up: from when to when this watcher heard nothing because it did not run.
    """

    def __init__(self, endpoint: str, robot: str) -> None:
        super().__init__("watch")
        self._endpoint, self._robot = endpoint, robot
        self.speeds: list[tuple[float, float]] = []
        self.frames: list[tuple[float, int]] = []
        self.arrivals: dict[str, list[float]] = {name: [] for name in TOPICS}
        self.commands: list[tuple[float, Velocity]] = []
        self.headings: list[tuple[float, Heading]] = []
        self.held_up: list[tuple[float, float]] = []
        self._wall_ahead_s = wall_ahead_s()

    def moving(self, since_s: float = 0.0) -> bool:
        """Whether the robot is driving by its newest state, if that is of `since_s` or later."""
        return bool(self.speeds) and self.speeds[-1][0] >= since_s and self.speeds[-1][1] > MOVING_MPS

    def watched(self, until_s: float) -> bool:
        """Whether a state of `until_s` or later has come."""
        return bool(self.speeds) and self.speeds[-1][0] >= until_s

    def still_after_s(self, since_s: float) -> float | None:
        """Time from `since_s` to the first true state at rest; None when none was heard of."""
        rest = [time_s for time_s, speed in self.speeds if time_s >= since_s and speed < STILL_MPS]
        return rest[0] - since_s if rest else None

    def fastest_mps(self, since_s: float) -> float:
        """Highest true speed from `since_s` on; infinite when nothing was heard: silence proves nothing."""
        return max((speed for time_s, speed in self.speeds if time_s >= since_s), default=float("inf"))

    def back_after_s(self, service: str, since_s: float, quiet_s: float = 0.05) -> float | None:
        """Time from `since_s` to the service's first message; those already under way do not count."""
        later = [time_s for time_s in self.arrivals.get(service, []) if time_s > since_s + quiet_s]
        return later[0] - since_s if later else None

    def silent_s(self) -> dict[str, float]:
        """How long ago each stream was heard last: where a link is missing."""
        now_s = time.monotonic()
        return {name: round(now_s - times[-1], 1) for name, times in self.arrivals.items() if times}

    def told_to_stand_s(self, since_s: float) -> float | None:
        """When the wheels' command was zero first, at `since_s` or later: said so, or run out unrenewed.

        None when it never was.
        """
        ends, last = [], float("inf")
        for (time_s, command), (next_s, _) in pairwise([*self.commands, (last, None)]):
            moving_until_s = min(next_s, time_s + command.ttl_ms / 1000.0)
            ends.append((time_s, time_s) if command.stands else (time_s, moving_until_s))
        still_s = max((end_s for time_s, end_s in ends if time_s <= since_s), default=since_s)
        if still_s <= since_s:
            return since_s
        for (_, end_s), (next_s, next_end_s) in pairwise([*ends, (last, last)]):
            if end_s > since_s and end_s < next_s:
                return end_s
            if next_s > since_s and next_end_s == next_s < last:
                return next_s
        return None

    def ran_on_s(self, since_s: float = 0.0) -> float:
        """Longest time from a heading that says go to a robot that moves, with none in between.

        Only while the planner's headings reach this session: drive may hear what the watcher does not. What
        came while the watcher was held up is not known, so the time begins anew when it goes on.
        """
        going = [time_s for time_s, heading in self.headings if heading.action == "go"]
        answered = {command.seq for _, command in self.commands if not command.stands}
        unheard = answered - {heading.seq for _, heading in self.headings}
        deaf = [time_s for time_s, command in self.commands if command.seq in unheard]
        longest_s, place = 0.0, 0
        for time_s, speed in self.speeds:
            while place < len(going) and going[place] <= time_s:
                place += 1
            if place and speed > MOVING_MPS and time_s >= since_s:
                heard_s = going[place - 1]
                if any(heard_s <= command_s <= time_s for command_s in deaf):
                    continue
                for _, on_s in (span for span in self.held_up if span[0] < time_s):
                    heard_s = max(heard_s, on_s)
                longest_s = max(longest_s, time_s - heard_s)
        return longest_s

    def oldest_answer_s(self, since_s: float = 0.0) -> float:
        """Largest age of a frame, since it was first heard of, whose command still turned the wheels.

        Less the time for which the watcher was held up: it heard of the command that much later.
        """
        heard_s: dict[int, float] = {}
        for time_s, seq in self.frames:
            heard_s.setdefault(seq, time_s)
        moving = [(t, c.seq) for t, c in self.commands if not c.stands and t >= since_s]
        answered = [(time_s, heard_s[seq]) for time_s, seq in moving if seq in heard_s]
        return max(
            (time_s - from_s - self._held_up_s(from_s, time_s) for time_s, from_s in answered), default=0.0
        )

    def _held_up_s(self, from_s: float, until_s: float) -> float:
        return sum(max(0.0, min(b_s, until_s) - max(a_s, from_s)) for a_s, b_s in self.held_up)

    def _run(self) -> None:
        with open_bus(self._endpoint) as bus:
            inboxes = {name: self._subscribe(bus, name) for name in TOPICS}
            self._ready.set()
            turned_s = time.monotonic()
            while not self._stop.is_set():
                bus.wait(0.2)
                now_s = time.monotonic()
                if now_s - turned_s > HELD_UP_S:
                    self.held_up.append((turned_s, now_s))
                turned_s = now_s
                for name, inbox in inboxes.items():
                    for message in inbox.take_all():
                        self.arrivals[name].append(now_s)
                        if name == "truth":
                            sensed_s = message.stamp_ns / 1e9 - self._wall_ahead_s
                            self.speeds.append((sensed_s, message.speed_mps))
                            self.frames.append((sensed_s, message.seq))
                        elif name == "drive":
                            self.commands.append((now_s, message))
                        elif name == "planner":
                            self.headings.append((now_s, message))

    def _subscribe(self, bus: Bus, name: str):
        return bus.subscribe(TOPICS[name], robot=self._robot)
