"""From frame to command: how long the robot waits for what follows from a picture, across all processes."""

import time
from collections.abc import Mapping

import numpy as np

from experiments.bench.background import Background
from services.launcher.client.stack import Stack
from services.launcher.terminal.output import rounded
from shared.topics import COMMAND, FRAME

PERIOD_S = 0.2


class FrameTimes(Background):
    """Notes when each frame and the first command that follows from it arrive, on a session of its own.

    Attributes:
        frames: arrival of each frame, seconds of a monotonic clock, by its number.
        commands: arrival of the first command with that number.
    """

    def __init__(self, stack: Stack) -> None:
        """Listen to the stack's robot within the `with` block."""
        super().__init__("bench-frames")
        self._stack = stack
        self.frames: dict[int, float] = {}
        self.commands: dict[int, float] = {}

    def _run(self) -> None:
        with self._stack.session() as own:
            frames = own.bus.subscribe(FRAME, robot=own.robot)
            commands = own.bus.subscribe(COMMAND, robot=own.robot)
            self._ready.set()
            while not self._stop.is_set():
                if own.bus.wait(PERIOD_S):
                    now_s = time.perf_counter()  # before decoding: that would delay the stamp
                    for message in frames.take_all():
                        self.frames.setdefault(message.seq, now_s)
                    for command in commands.take_all():
                        self.commands.setdefault(command.seq, now_s)


def latency(frames: Mapping[int, float], commands: Mapping[int, float]) -> dict[str, float]:
    """Median and 99th percentile of frame to command, ms, and the share of frames that got one.

    Only frames between the first and the last command count: before and after them no mission drives.
    """
    if not commands:
        return {"frames": 0}
    asked = [seq for seq in frames if min(commands) <= seq <= max(commands)]
    waits_ms = [1e3 * (commands[seq] - frames[seq]) for seq in asked if seq in commands]
    if not waits_ms:
        return {"frames": len(asked)}
    return {
        "p50_ms": rounded(np.percentile(waits_ms, 50), 2),
        "p99_ms": rounded(np.percentile(waits_ms, 99), 2),
        "frames": len(asked),
        "answered": rounded(len(waits_ms) / len(asked), 3),
    }
