"""Teaching on real processes: a person drives, the robot maps, and drives the same way there and back."""

import math
import subprocess
import sys
import time
from itertools import pairwise
from typing import Any

import httpx
import pytest

from services.launcher.client.experimenter import Experimenter
from shared.bus import Bus
from shared.messages.drive import Manual
from shared.messages.simulation import Pose
from shared.topics import MANUAL, TRUTH
from tests.e2e.one_stack.conftest import Explored

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

MAP = "taught"
DRIVE_S = 300.0
STOPS = ((2.6, 1.3), (4.2, 1.4))
NEAR_M = 0.12
FAST_MPS, FAST_RADPS = 0.2, 0.6


class Person:
    """Drives by hand along true points, as somebody who sees the room does."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot = bus, robot
        self._truths, self._wishes = bus.subscribe(TRUTH, robot=robot), bus.publisher(MANUAL, robot=robot)
        self._pose: Pose | None = None

    def drive(self, points: list[tuple[float, float]]) -> None:
        """Go from point to point, then let go."""
        until_s = time.monotonic() + DRIVE_S
        for point in points:
            while not self._turn_and_go(*point):
                assert time.monotonic() < until_s, f"not at {point}: {self._pose}"
        self._wish("release")

    def _turn_and_go(self, x_m: float, y_m: float) -> bool:
        self._bus.wait(0.05)
        self._pose = pose = ([truth.pose for truth in self._truths.take_all()] or [self._pose])[-1]
        if pose is None:
            return False
        away_m = math.dist((pose.x_m, pose.y_m), (x_m, y_m))
        off_rad = math.remainder(math.atan2(y_m - pose.y_m, x_m - pose.x_m) - pose.yaw_rad, math.tau)
        forward_mps = min(FAST_MPS, away_m) if abs(off_rad) < 0.4 else 0.0
        self._wish("drive", forward_mps, max(-FAST_RADPS, min(FAST_RADPS, off_rad)))
        return away_m < NEAR_M

    def _wish(self, action: Any, forward_mps: float = 0.0, turn_radps: float = 0.0) -> None:
        seq = time.monotonic_ns() // 1000
        self._wishes.put(
            Manual(
                seq=seq,
                robot=self._robot,
                who="anna",
                action=action,
                forward_mps=forward_mps,
                turn_radps=turn_radps,
            )
        )


def topnav(explored: Explored, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "services.launcher", *words, "--data-dir", str(explored.data_dir)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DRIVE_S)


def test_a_way_that_a_person_drives_is_kept_and_driven_back_and_there(
    http: httpx.Client, explored: Explored
) -> None:
    bus, robot = explored.stack.bus, explored.stack.robot
    hand = Experimenter(bus, robot)
    explored.game.begin(seed=1)
    begun = topnav(explored, "teach", "--map", MAP, "--route", "tour")
    assert begun.returncode == 0, begun.stderr
    start = hand.truth().pose
    points = explored.space.shortest_path((start.x_m, start.y_m), STOPS[1])
    Person(bus, robot).drive(points[1:])
    mission = http.get(f"/api/robots/{robot}/mission").json()
    assert mission["state"] == "running", mission["reason"]
    end = hand.truth().pose
    told = topnav(explored, "teach", "--finish")
    assert "route 'tour' leads along" in told.stdout, told.stderr
    route = http.get(f"/api/maps/{MAP}/route", params={"name": "Tour"}).json()
    edges = {(edge["a"], edge["b"]): edge for edge in http.get(f"/api/maps/{MAP}/edges").json()}
    legs = [edges[min(pair), max(pair)] for pair in pairwise(route["nodes"])]
    assert all(leg["traversals"] for leg in legs)
    for words, goal in ((("--reverse",), start), ((), end)):
        driven = topnav(explored, "route", "drive", "tour", "--map", MAP, *words)
        assert driven.returncode == 0, driven.stderr
        there = hand.truth().pose
        assert math.dist((there.x_m, there.y_m), (goal.x_m, goal.y_m)) < 0.3
