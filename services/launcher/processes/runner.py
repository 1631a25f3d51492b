"""The life of one service: wait, start, become healthy, die, start again."""

import logging
import signal
from collections.abc import Callable
from enum import StrEnum

from services.launcher.compose.local import ProcessSpec
from services.launcher.processes.health import Health
from services.launcher.processes.process import ChildProcess
from services.launcher.processes.restart import RestartPolicy

log = logging.getLogger(__name__)
HUNG_AFTER_S = 15.0
"""A process that was healthy and then silent for so long is killed and started again."""

CANNOT_START = 126
"""Exit code of what could not be started, as shells have it."""


class State(StrEnum):
    """What a service is doing."""

    WAITING = "waiting"
    STARTING = "starting"
    HEALTHY = "healthy"
    SILENT = "silent"
    RESTARTING = "restarting"
    DEGRADED = "degraded"
    EXITED = "exited"


class ServiceRunner:
    """State machine of one service; `step` is called often, in one thread.

    Args:
        spec: what to run.
        health: how to tell that it is ready.
        spawn: starts the process.
        policy: when to start it again.
    """

    def __init__(
        self,
        spec: ProcessSpec,
        health: Health,
        spawn: Callable[[ProcessSpec], ChildProcess],
        policy: RestartPolicy,
    ) -> None:
        self.spec = spec
        self.state = State.WAITING
        self.child: ChildProcess | None = None
        self.restarts = 0
        self.last_exit: int | None = None
        self._health, self._spawn, self._policy = health, spawn, policy
        self._exits_s: tuple[float, ...] = ()
        self._stale: frozenset[str] = frozenset()
        self._start_at_s = 0.0
        self._started_s = 0.0
        self._silent_since_s = 0.0

    @property
    def pid(self) -> int | None:
        """Process id while it runs."""
        return self.child.pid if self.child else None

    def satisfies(self, must_be_healthy: bool) -> bool:
        """Tell whether a service that depends on this one may start."""
        return self.state is State.HEALTHY or (not must_be_healthy and self.child is not None)

    def step(self, now_s: float, may_start: bool, watch_hung: bool) -> None:
        """Look once and act.

        Args:
            now_s: monotonic time.
            may_start: whether all that it needs is there.
            watch_hung: False while the bus itself is down and silence says nothing.
        """
        if self.child is None:
            if self._is_due(now_s, may_start):
                self._start(now_s)
            return
        code = self.child.exit_code()
        if code is not None:
            self._ended(code, now_s)
        else:
            self._look(now_s, watch_hung)

    def _is_due(self, now_s: float, may_start: bool) -> bool:
        if self.state is State.WAITING:
            return may_start
        return self.state is not State.EXITED and now_s >= self._start_at_s

    def _start(self, now_s: float) -> None:
        self._started_s = now_s
        self._stale = self._health()
        try:
            self.child = self._spawn(self.spec)
        except OSError as error:  # a full disk, or no process or file descriptor left: like an exit at once
            log.error("%s cannot be started: %s", self.spec.name, error)
            self._ended(CANNOT_START, now_s)
            return
        if self.state is not State.DEGRADED:
            self._become(State.STARTING)

    def _ended(self, code: int, now_s: float) -> None:
        if self.child is not None:
            self.child.send(signal.SIGKILL)  # what the dead process may have left in its group
        self.child, self.last_exit = None, code
        if not self.spec.restart:
            self._become(State.EXITED)
            return
        self._exits_s = (*self._policy.recent(self._exits_s, now_s), now_s)
        self.restarts += 1
        pause_s = self._policy.pause_s(self._exits_s, now_s)
        self._start_at_s = now_s + pause_s
        log.warning("%s ended with %d, starts again in %.1f s", self.spec.name, code, pause_s)
        self._become(State.DEGRADED if self._policy.is_storm(self._exits_s, now_s) else State.RESTARTING)

    def _look(self, now_s: float, watch_hung: bool) -> None:
        young = now_s - self._started_s < self.spec.ready_after_s
        if self._health() - self._stale and not young:
            self._silent_since_s = now_s
            # In a crash storm a process that just became ready proves little: it has to last.
            settled = now_s - self._started_s >= self._policy.settle_s
            if settled or not self._policy.is_storm(self._exits_s, now_s):
                self._become(State.HEALTHY)
        elif self.state is State.HEALTHY:
            self._silent_since_s = now_s
            self._become(State.SILENT)
        elif self.state is State.SILENT and not watch_hung:
            self._silent_since_s = now_s
        elif self.state is State.SILENT and now_s - self._silent_since_s > HUNG_AFTER_S and self.child:
            log.warning("%s runs but has been silent for %.0f s: killed", self.spec.name, HUNG_AFTER_S)
            self.child.send(signal.SIGKILL)

    def _become(self, state: State) -> None:
        if state is not self.state:
            log.info("%s: %s", self.spec.name, state.value)
            self.state = state
