"""Waiting for services, and one clear line when it was in vain."""

import json
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from services.launcher.processes.runner import State
from services.launcher.processes.state import ServiceStatus

PERIOD_S = 0.02  # less than the supervisor's own
TELL_S = 1.0  # chosen: as often as people look


class LaunchError(RuntimeError):
    """The stack is not as it should be."""


class KeepsEndingError(LaunchError):
    """A service ends again and again: waiting longer is of no use."""


def require_healthy(
    status: Callable[[], Mapping[str, ServiceStatus]],
    names: Sequence[str],
    timeout_s: float,
    logs: Path,
    other_than: int | None = None,
    stop: threading.Event | None = None,
    told: Callable[[str], None] | None = None,
) -> None:
    """Wait until all of `names` are healthy (with a pid other than `other_than`), or `stop` is set.

    Meanwhile `told` hears about once a second what is waited for, and what the last of it said.

    Raises:
        KeepsEndingError: one has crashed for good or keeps crashing.
        LaunchError: the time is up.
    """
    deadline_s, tell_s = time.monotonic() + timeout_s, time.monotonic() + TELL_S
    while True:
        now = status()
        waiting = [n for n in names if now[n].state is not State.HEALTHY or now[n].pid == other_than]
        if not waiting or (stop and stop.is_set()):
            return
        crashed = [n for n in waiting if now[n].state in (State.DEGRADED, State.EXITED)]
        if crashed and other_than is None:
            raise KeepsEndingError(
                f"{crashed[0]} keeps ending (exit {now[crashed[0]].last_exit}): {hint(crashed[0], logs)}"
            )
        if time.monotonic() > deadline_s:
            states = ", ".join(f"{name} {now[name].state.value}" for name in waiting)
            failed = min(waiting, key=lambda n: (now[n].last_exit is None, now[n].state is State.WAITING))
            raise LaunchError(
                f"not healthy after {timeout_s:.0f} s: {states}; {hint(failed, logs)}; "
                "--timeout-s gives it longer"
            )
        if told is not None and time.monotonic() >= tell_s:
            tell_s = time.monotonic() + TELL_S
            told(waiting_for(waiting, now, logs))
        time.sleep(PERIOD_S)


def waiting_for(names: Sequence[str], now: Mapping[str, ServiceStatus], logs: Path) -> str:
    """Return what is waited for, and what the first of those that have started said last."""
    started = [name for name in names if now[name].state is not State.WAITING]
    said = _said(logs / f"{started[0]}.jsonl") if started else ""
    return ", ".join(names) + (f" ({started[0]}: {said})" if said else "")


def log_lines(log: Path) -> list[str]:
    """Lines of a service's log; none where there is none."""
    return log.read_text(encoding="utf-8", errors="replace").splitlines() if log.exists() else []


def _said(log: Path) -> str:
    lines = log_lines(log)
    try:
        return str(json.loads(lines[-1])["text"])[:120]
    except (IndexError, KeyError, TypeError, ValueError):
        return ""


def hint(service: str, logs: Path) -> str:
    """Return the last line of a service's log, and where to read on."""
    path = logs / f"{service}.jsonl"
    lines = log_lines(path)
    return f"{lines[-1][:300] if lines else 'its log is empty'} (see {path})"
