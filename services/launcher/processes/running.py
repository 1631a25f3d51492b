"""A stack that a person runs: in this process, or left behind in one of its own, and stopped from outside."""

import contextlib
import logging
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from dotenv import dotenv_values

from services.launcher.compose.compose_file import COMPOSE_FILE
from services.launcher.processes.runner import State
from services.launcher.processes.stack_settings import Ports, StackSettings, located
from services.launcher.processes.state import AlreadyRunningError, ServiceStatus, StackState, StateFolder
from services.launcher.processes.supervisor import Launcher
from services.launcher.processes.wait import TELL_S, LaunchError, waiting_for
from shared.inbox import wait_until
from shared.lifecycle import JsonFormatter, stop_on_signals

STOP_S = 30.0
"""What a launcher that gave up may take to stop its services and say why: longer than the grace of any."""

LOOK_S = 1.0
"""Chosen: a launcher that can no longer do its work ends so soon."""


Told = Callable[[str], None]


def run_foreground(
    settings: StackSettings,
    compose_file: Path,
    timeout_s: float,
    watch: Callable[[Mapping[str, ServiceStatus]], None],
    healthy: Callable[[str], None],
    told: Told | None = None,
) -> None:
    """Run until SIGINT or SIGTERM.

    Args:
        settings: what was chosen; ports are those of the environment or of `.env`.
        compose_file: which processes there are.
        timeout_s: how long the start may take.
        watch: hears every change of status.
        healthy: hears the address of the console once all is healthy.
        told: hears meanwhile, about once a second, what is waited for.

    Raises:
        LaunchError: the stack does not come up.
    """
    stop = stop_on_signals()
    variables = variables_with_dotenv(compose_file.parent)
    launcher = Launcher(
        settings.data_dir,
        settings.world,
        settings.lockstep,
        settings.seed,
        settings.profile,
        Ports.from_variables(variables),
        variables=variables,
        compose_file=compose_file,
        watch=watch,
        secure=settings.secure,
        camera=settings.camera,
        ros=settings.ros,
        signs=settings.signs,
        fleet=settings.fleet,
        told=told,
    )
    _log_to(launcher.logs / "launcher.jsonl")
    launcher.start(wait=False)
    try:
        launcher.wait_all_healthy(timeout_s, stop)
        if not stop.is_set():
            healthy(launcher.gateway_url)
        while not stop.wait(LOOK_S):
            if not launcher.running:
                raise LaunchError(f"the launcher stopped looking after the services: see {launcher.logs}")
    finally:
        launcher.stop()


def variables_with_dotenv(folder: Path) -> dict[str, str]:
    """Return the environment on top of `.env` beside the Compose file, as `docker compose` does."""
    return {k: v for k, v in dotenv_values(folder / ".env").items() if v is not None} | dict(os.environ)


def start_detached(
    settings: StackSettings, compose_file: Path, timeout_s: float, told: Told | None = None
) -> StackState:
    """Start `topnav up --foreground` in the background and wait until all is healthy.

    Meanwhile `told` hears about once a second what is waited for.

    Raises:
        AlreadyRunningError: the data folder belongs to a running stack.
        LaunchError: it ended or is not healthy in time; it is stopped then.
    """
    folder = StateFolder(settings.data_dir)
    if folder.owned():
        raise AlreadyRunningError(f"a stack is already running in {settings.data_dir}: see 'topnav status'")
    folder.logs.mkdir(parents=True, exist_ok=True)
    log_path = folder.logs / "launcher.log"
    with log_path.open("wb") as log:
        child = subprocess.Popen(
            [sys.executable, "-m", "services.launcher", *_arguments(settings, compose_file, timeout_s)],
            cwd=COMPOSE_FILE.parent,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    tell_s = time.monotonic() + TELL_S

    def up() -> StackState | None:
        nonlocal tell_s
        state = folder.read()
        if told is not None and state is not None and time.monotonic() >= tell_s:
            tell_s = time.monotonic() + TELL_S
            waiting = [n for n, one in state.services.items() if one.state is not State.HEALTHY]
            told(waiting_for(waiting, state.services, folder.logs))
        return state if state and state.launcher_pid == child.pid and state.healthy else None

    # It counts the time itself: whoever ended it first would read of services that stop, not of what failed.
    wait_until(lambda: child.poll() is not None or up() is not None, timeout_s + STOP_S, 0.1)
    if (state := up()) is not None:
        return state
    child.send_signal(signal.SIGTERM)
    with contextlib.suppress(subprocess.TimeoutExpired):
        child.wait(STOP_S)
    lines = log_path.read_text(encoding="utf-8", errors="replace").splitlines()
    last = lines[-1].removeprefix("topnav: ") if lines else "no output"
    raise LaunchError(f"the stack did not come up: {last} (see {log_path.parent})")


def stop_stack(data_dir: Path, timeout_s: float) -> str:
    """Ask the launcher to stop, wait, and kill it if it does not; the kernel then kills its services.

    Returns:
        What happened, in one line.

    """
    folder = StateFolder(data_dir)
    if not folder.owned():
        folder.release()  # a killed launcher leaves its state file
        return f"no stack runs in {data_dir}"
    for number in (signal.SIGTERM, signal.SIGKILL):
        owner = folder.owner()
        if owner is None:
            return "stopped"
        os.kill(owner, number)
        if wait_until(lambda: not folder.owned(), timeout_s, 0.05) and number == signal.SIGTERM:
            return "stopped"
    return f"the launcher did not stop within {timeout_s:.0f} s and was killed with its services"


def _log_to(path: Path) -> None:
    """Keep the launcher's own log beside those of the services, and the shell free of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handler = logging.FileHandler(path)
    handler.setFormatter(JsonFormatter("launcher"))
    logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)


def _arguments(settings: StackSettings, compose_file: Path, timeout_s: float) -> list[str]:
    arguments = ["up", "--foreground", "--data-dir", str(settings.data_dir), "--timeout-s", str(timeout_s)]
    arguments += ["--file", str(compose_file)]
    for name in ("world", "seed", "profile", "camera", "ros", "foxglove"):
        value = getattr(settings, name)
        value = located(value) if name in ("world", "ros") else value
        arguments += [f"--{name}", str(value)] if value is not None else []
    if settings.lockstep is not None:
        arguments.append("--lockstep" if settings.lockstep else "--no-lockstep")
    arguments += [f"--{name}" for name in ("secure", "signs", "fleet") if getattr(settings, name)]
    return arguments
