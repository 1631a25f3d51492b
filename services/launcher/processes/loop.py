"""The thread that steps every service runner, and stops all of them in the reverse of the start order."""

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from services.launcher.processes.process import ChildProcess, stop_all
from services.launcher.processes.runner import ServiceRunner, State
from services.launcher.processes.state import ServiceStatus

log = logging.getLogger(__name__)

PERIOD_S = 0.05
"""Chosen: an ended process is noticed sooner than the first pause before a restart (0.1 s)."""
BEAT_S = 1.0
"""Chosen: how often the state on disk says that this loop runs, and logs are looked at."""


class SupervisorLoop:
    """Steps the runners in one thread, which also starts every process (see ChildProcess for why).

    Args:
        runners: service name -> runner.
        stages: start order; the first stage is what the others talk through.
        changed: called in the loop's thread after any change, with the status of all services; where it
            raises OSError (a full disk), again at the next beat.
        beat: called in the loop's thread about once a second; may raise OSError.
    """

    def __init__(
        self,
        runners: Mapping[str, ServiceRunner],
        stages: Sequence[Sequence[str]],
        changed: Callable[[Mapping[str, ServiceStatus]], None],
        beat: Callable[[], None],
    ) -> None:
        self._runners, self._stages, self._changed, self._beat = runners, stages, changed, beat
        self._stop, self._stepping = threading.Event(), threading.Lock()
        # A daemon: should the main thread die without stopping us, the process ends and the kernel kills all.
        self._thread = threading.Thread(target=self._run, name="supervisor", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Stop all services and wait for the end; harmless when it never started."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join()

    @property
    def running(self) -> bool:
        """Whether the loop still looks after the services."""
        return self._thread.is_alive()

    def status(self) -> dict[str, ServiceStatus]:
        """Describe all services as of now, none of them half way from one state to the next."""
        with self._stepping:
            return {
                name: ServiceStatus(state=r.state, pid=r.pid, restarts=r.restarts, last_exit=r.last_exit)
                for name, r in self._runners.items()
            }

    def child(self, name: str) -> ChildProcess | None:
        """Return the process of one service, None while it has none.

        Raises:
            KeyError: no such service; names those there are.
        """
        if name not in self._runners:
            raise KeyError(f"no service {name!r}; there are {sorted(self._runners)}")
        return self._runners[name].child

    def _run(self) -> None:
        told: dict[str, ServiceStatus] | None = {}
        beat_s = float("-inf")
        try:
            while not self._stop.is_set():
                now_s = time.monotonic()
                self._step_all(now_s)
                status, beats = self.status(), now_s - beat_s >= BEAT_S
                if status != told and (beats or told is not None):
                    told = status if self._done(partial(self._changed, status)) else None
                if beats:
                    beat_s = now_s
                    self._done(self._beat)
                self._stop.wait(PERIOD_S)
        finally:
            self._stop_services()

    def _done(self, write: Callable[[], None]) -> bool:
        """Whether it worked: what a full disk refuses must not end the services."""
        try:
            write()
        except OSError as error:
            log.error("state of the stack not written, tried again: %s", error)
            return False
        return True

    def _step_all(self, now_s: float) -> None:
        base = set(self._stages[0])
        base_healthy = all(self._runners[name].state is State.HEALTHY for name in base)
        for stage in self._stages:
            for name in stage:
                runner = self._runners[name]
                ready = all(
                    self._runners[other].satisfies(healthy) for other, healthy in runner.spec.needs.items()
                )
                try:
                    with self._stepping:
                        runner.step(now_s, ready, watch_hung=base_healthy or name in base)
                except OSError as error:  # no file descriptor or process left to look with
                    log.error("%s could not be looked at, tried again: %s", name, error)

    def _stop_services(self) -> None:
        for stage in reversed(self._stages):
            runners = [self._runners[name] for name in stage]
            stop_all({runner.child: runner.spec.stop_grace_s for runner in runners if runner.child})
            with self._stepping:
                for runner in runners:
                    runner.child, runner.state = None, State.EXITED
        self._done(partial(self._changed, self.status()))
