"""`topnav up`: keep a stack running in this process, or in one left behind."""

import contextlib
import logging
import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

from dotenv import dotenv_values
from rich.console import Console

from services.launcher.processes.compose_file import COMPOSE_FILE
from services.launcher.processes.stack_settings import Ports, StackSettings, located
from services.launcher.processes.state import AlreadyRunningError, ServiceStatus, StackState, StateFolder
from services.launcher.processes.supervisor import Launcher
from services.launcher.processes.wait import LaunchError
from services.launcher.terminal.display import Changes, status_table
from shared.lifecycle import JsonFormatter, stop_on_signals

POLL_S = 0.1


def variables_with_dotenv(folder: Path) -> dict[str, str]:
    """Return the environment on top of `.env` beside the Compose file, as `docker compose` does."""
    return {k: v for k, v in dotenv_values(folder / ".env").items() if v is not None} | dict(os.environ)


def run_foreground(settings: StackSettings, compose_file: Path, timeout_s: float) -> None:
    """Run until SIGINT or SIGTERM. Raises LaunchError when the stack does not come up."""
    stop = stop_on_signals()
    console, changes = Console(), Changes()
    variables = variables_with_dotenv(compose_file.parent)

    def watch(services: Mapping[str, ServiceStatus]) -> None:
        for line in changes.lines(services):
            console.print(line, highlight=False)

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
    )
    _log_to(launcher.logs / "launcher.jsonl")
    launcher.start(wait=False)
    try:
        launcher.wait_all_healthy(timeout_s, stop)
        if not stop.is_set():
            console.print(f"all healthy; console {launcher.gateway_url}, stop with Ctrl+C or 'topnav down'")
        stop.wait()
    finally:
        launcher.stop()


def _log_to(path: Path) -> None:
    """Keep the launcher's own log beside those of the services, and the shell free of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handler = logging.FileHandler(path)
    handler.setFormatter(JsonFormatter("launcher"))
    logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)


def run_detached(settings: StackSettings, compose_file: Path, timeout_s: float) -> None:
    """Start `topnav up --foreground` in the background and wait until all is healthy.

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
    state = _follow(child, folder, timeout_s, log_path)
    console = Console()
    console.print(status_table(state.services))
    console.print(f"console {state.gateway_url}; stop with 'topnav down'", highlight=False)


def _follow(
    child: subprocess.Popen[bytes], folder: StateFolder, timeout_s: float, log_path: Path
) -> StackState:
    deadline_s = time.monotonic() + timeout_s
    while child.poll() is None:
        state = folder.read()
        if state and state.launcher_pid == child.pid and state.healthy:
            return state
        if time.monotonic() > deadline_s:
            child.send_signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(30.0)
            break
        time.sleep(POLL_S)
    lines = log_path.read_text(encoding="utf-8", errors="replace").splitlines()
    last = lines[-1].removeprefix("topnav: ") if lines else "no output"
    raise LaunchError(f"the stack did not come up: {last} (see {log_path.parent})")


def _arguments(settings: StackSettings, compose_file: Path, timeout_s: float) -> list[str]:
    arguments = ["up", "--foreground", "--data-dir", str(settings.data_dir), "--timeout-s", str(timeout_s)]
    arguments += ["--file", str(compose_file)]
    for name in ("world", "seed", "profile"):
        value = located(settings.world) if name == "world" else getattr(settings, name)
        arguments += [f"--{name}", str(value)] if value is not None else []
    if settings.lockstep is not None:
        arguments.append("--lockstep" if settings.lockstep else "--no-lockstep")
    if settings.secure:
        arguments.append("--secure")
    return arguments
