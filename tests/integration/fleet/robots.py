"""Robots of a fleet: a planner and what stands in for a body, each a session and a thread of this process."""

import os
import subprocess
import sys
import threading
from contextlib import ExitStack
from pathlib import Path

from services.planner.service import run
from services.planner.settings import PlannerSettings
from shared.bus import open_bus
from tests.integration.dispatch.robot import Robot

MISSIONS = Path(__file__).parent / "missions"
ROOT = Path(__file__).resolve().parents[3]


class Child:
    """A service as a process."""

    def __init__(self, service: str, environment: dict[str, str]) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.patient", f"services.{service}"],
            cwd=ROOT,
            env={**os.environ, **environment},
        )

    def kill(self) -> None:
        """As `kill -9` does."""
        self._process.kill()
        self._process.wait()


class FleetRobot:
    """Its body, the planner's own loop, and a dispatch process that looks often."""

    def __init__(self, name: str, endpoint: str) -> None:
        self.name = name
        self._opened, self._stop = ExitStack(), threading.Event()
        self._opened.enter_context(Robot(self._opened.enter_context(open_bus(endpoint)), name=name))
        bus = self._opened.enter_context(open_bus(endpoint))
        settings = PlannerSettings(endpoint=endpoint, robot=name, missions_folder=MISSIONS)
        self._planner = threading.Thread(target=run, args=(settings, bus, self._stop), daemon=True)
        self._planner.start()
        self._dispatch = Child(
            "dispatch",
            {"TOPNAV_ENDPOINT": endpoint, "TOPNAV_ROBOT": name, "DISPATCH_PERIOD_S": "0.1"},
        )

    def kill(self) -> None:
        """All of it at once; a planner that ends says nothing, whether it is asked to or killed."""
        self._dispatch.kill()
        self._stop.set()
        self._planner.join()
        self._opened.close()
