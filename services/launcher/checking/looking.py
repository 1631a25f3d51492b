"""What comes from a robot over the bus: pictures, distances, odometry, and why they do not."""

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from services.launcher.client.failure import ExperimentError
from services.launcher.processes.wait import log_lines
from shared.bus import Bus
from shared.messages.body import Odometry
from shared.messages.features import Features
from shared.messages.matching import MatchRequest, NodeMatch
from shared.messages.sensors import Frame, Ranges
from shared.queries import QueryError
from shared.topics import FEATURES, FRAME, MATCH, ODOMETRY, RANGES

PERIOD_S = 0.05
KEPT = 6
"""Frames that are looked at; a raw picture has 6 MB."""
FRESH_S = 10.0
"""Longest wait for a picture's features; chosen: three a second, 0.6 s late, on a busy machine."""
MATCH_S = 10.0
SAYS, LAST_LINES = {"WARNING", "ERROR"}, 50
MAP = "none"
"""No node of any map is asked for."""


@dataclass
class Looked:
    """What came within a while.

    Attributes:
        frames: some of them; arrivals_s: when each came, monotonic; ages_s: how old it was by its stamp.
        ranges: all distances.
    """

    frames: list[Frame] = field(default_factory=list)
    arrivals_s: list[float] = field(default_factory=list)
    ages_s: list[float] = field(default_factory=list)
    ranges: list[Ranges] = field(default_factory=list)


class Looker:
    """Hears one robot."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot = bus, robot
        self._frames = bus.subscribe(FRAME, robot=robot)
        self._ranges = bus.subscribe(RANGES, robot=robot)
        self._features = bus.subscribe(FEATURES, robot=robot)
        self._odometry = bus.subscribe(ODOMETRY, robot=robot)
        self.odometry: list[Odometry] = []

    def look(self, seconds: float) -> Looked:
        """Look for so long."""
        looked, until_s = Looked(), time.monotonic() + seconds
        while time.monotonic() < until_s:
            self._bus.wait(PERIOD_S)
            self.follow()
            frame, ranges = self._frames.take(), self._ranges.take()
            if frame is not None:
                looked.arrivals_s.append(time.monotonic())
                looked.ages_s.append(1e-9 * (time.time_ns() - frame.stamp_ns))
                looked.frames = [*looked.frames[-KEPT + 1 :], frame]
            if ranges is not None:
                looked.ranges.append(ranges)
        return looked

    def features_after(self, after_ns: int) -> Features:
        """Features of a picture that was taken later.

        Raises:
            ExperimentError: none comes.
        """
        until_s = time.monotonic() + FRESH_S
        while time.monotonic() < until_s:
            self._bus.wait(PERIOD_S)
            self.follow()
            features = self._features.take()
            if features is not None and features.stamp_ns > after_ns:
                return features
        raise ExperimentError(f"no picture came through the feature service within {FRESH_S:.0f} s")

    def follow(self) -> None:
        """Keep what odometry says."""
        self.odometry += self._odometry.take_all()

    def compare(self, before: Features, after: Features) -> NodeMatch:
        """How the camera moved between two pictures.

        Raises:
            ExperimentError: the feature service does not say.
        """
        request = MatchRequest(map=MAP, features=before, targets=(after,))
        try:
            return self._bus.ask(MATCH, request, MATCH_S, robot=self._robot).results[0]
        except QueryError as error:
            raise ExperimentError(f"the feature service compares no pictures: {error}") from error


def last_words(logs: Path, services: Mapping[str, str], since_s: float) -> list[str]:
    """What these services complained of last, by their logs; who has none is left out.

    Args:
        logs: folder of the launcher's logs.
        services: name of a log, and what people call who writes it.
        since_s: not what was said before, seconds since the epoch.
    """
    since = time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(since_s))
    found = []
    for name, called in services.items():
        entries = [_entry(line) for line in log_lines(logs / f"{name}.jsonl")[-LAST_LINES:]]
        texts = [one["text"] for one in entries if one.get("level") in SAYS and one["time"] >= since]
        found += [f"{called} says: {text}" for text in dict.fromkeys(texts)]
    return found


def _entry(line: str) -> dict[str, Any]:
    """A line of a log; empty for one that is half written, or of a program that knows no JSON."""
    try:
        entry = json.loads(line)
    except ValueError:
        return {}
    return entry if isinstance(entry, dict) else {}
