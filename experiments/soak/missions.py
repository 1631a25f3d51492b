"""One mission after the other to random spots, from pictures, while everything around breaks."""

import threading
import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from experiments.soak.journal import Journal
from services.launcher.client.experimenter import Experimenter
from services.launcher.client.failure import ExperimentError
from services.launcher.client.mission import TERMINAL, goal_features
from services.launcher.client.stack import Stack
from services.launcher.evaluation.rounds import hiding_place
from services.launcher.terminal.output import rounded
from shared.messages.missions import MissionRequest, MissionStatus
from shared.queries import QueryError
from shared.topics import MISSION
from shared.wire import WireError
from simulator.world.freespace import FreeSpace

MAX_STEPS = 600  # six times a usual round of the apartment
LONGEST_S = 900.0
"""MAX_STEPS at a frame a second, and half as long again for services that restart."""

PATIENCE_S = 120.0
"""As long as the launcher may take to bring everything up."""

ANSWER_S = 10.0  # as in services/launcher/client/mission.py
PERIOD_S = 1.0  # missions take minutes

T = TypeVar("T")


class _StoppedError(Exception):
    """The soak ends."""


class Missions:
    """Chooses a spot, gets its picture, goes there, and keeps how it ended."""

    def __init__(self, stack: Stack, space: FreeSpace, map_name: str, seed: int, journal: Journal) -> None:
        self._stack, self._space, self._map, self._journal = stack, space, map_name, journal
        self._rng = np.random.default_rng(seed)
        self._experimenter = Experimenter(stack.bus, stack.robot)
        self._count = 0

    def run(self, stop: threading.Event) -> None:
        """Until `stop`; the mission under way then is cancelled and does not count."""
        while not stop.is_set():
            try:
                self._one(stop)
            except ExperimentError as error:
                self._journal.violation("every service answers", str(error))
            except _StoppedError:
                break
        self._cancel()

    def _one(self, stop: threading.Event) -> None:
        self._count += 1
        mission_id = f"soak-{self._count}-{time.time_ns():x}"
        seeker = self._patiently(lambda: self._experimenter.truth().pose, stop)
        place = hiding_place(self._space, seeker, self._rng)
        picture = self._patiently(lambda: self._experimenter.look(place), stop)
        goal = self._patiently(lambda: goal_features(self._stack.bus, picture), stop)
        request = MissionRequest(
            action="goto",
            map=self._map,
            mission_id=mission_id,
            goal=goal,
            seed=self._count,
            max_steps=MAX_STEPS,
        )
        started_s = time.monotonic()
        self._patiently(lambda: self._begin(request), stop)
        status = self._follow(mission_id, started_s, stop)
        if status is None:
            return
        final = self._patiently(lambda: self._experimenter.truth().pose, stop)
        left_m = float(np.hypot(final.x_m - place.x_m, final.y_m - place.y_m))
        self._journal.add(
            "results",
            state="unknown" if status.state == "idle" else status.state,
            failure=status.failure,
            steps=status.step,
            wall_s=rounded(time.monotonic() - started_s, 1),
            distance_m=rounded(left_m, 3),
            reason=status.reason,
        )

    def _begin(self, request: MissionRequest) -> MissionStatus:
        """Start it; one that the planner took up again after a restart is ended first."""
        status = self._ask(action="status")
        if status.mission_id == request.mission_id:
            return status
        if status.state in ("running", "paused"):
            self._ask(action="cancel")
        return self._stack.bus.ask(MISSION, request, ANSWER_S, robot=self._stack.robot)

    def _follow(self, mission_id: str, started_s: float, stop: threading.Event) -> MissionStatus | None:
        """The last status of the mission, idle if its planner restarted just then; None without an end."""
        while not stop.wait(PERIOD_S):
            status = self._patiently(lambda: self._ask(action="status"), stop)
            if status.mission_id != mission_id:
                return status.model_copy(update={"state": "idle"})
            if status.state in TERMINAL or status.state == "idle":
                if status.state == "failed" and not status.failure:
                    self._journal.violation("every failure has a kind", status.reason)
                return status
            if time.monotonic() - started_s > LONGEST_S:
                self._journal.violation("every mission ends", f"{LONGEST_S} s: {status.reason}")
                return None
        return None

    def _ask(self, **request: str) -> MissionStatus:
        return self._stack.bus.ask(
            MISSION, MissionRequest.model_validate(request), ANSWER_S, robot=self._stack.robot
        )

    def _patiently(self, ask: Callable[[], T], stop: threading.Event) -> T:
        """Ask again while services restart.

        Raises:
            ExperimentError: no answer for PATIENCE_S.
            _StoppedError: meanwhile the soak ends.
        """
        deadline_s = time.monotonic() + PATIENCE_S
        while True:
            try:
                return ask()
            except (QueryError, WireError) as error:
                if stop.is_set():
                    raise _StoppedError from error
                if time.monotonic() > deadline_s:
                    raise ExperimentError(f"no answer for {PATIENCE_S} s: {error}") from error
            time.sleep(PERIOD_S)

    def _cancel(self) -> None:
        try:
            self._ask(action="cancel")
        except (QueryError, WireError):
            return
