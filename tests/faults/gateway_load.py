"""The load on a gateway beside a drive service: what it does to the time from a heading to its command."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx

from experiments.bench.resources import RESIDENT, memory_mb
from shared.bus import open_bus, wait_until
from tests.faults.latency import Stopwatch, told

START_S = 60.0
STALLED, READERS = 200, 500
CLIENTS = 10
PER_CLIENT = READERS // CLIENTS + 10


@dataclass(frozen=True)
class Loaded:
    """A gateway process on the bus of a drive process."""

    endpoint: str
    address: str
    pid: int

    def alive(self) -> bool:
        """Whether it answers within half a minute."""
        with contextlib.suppress(httpx.HTTPError):
            return httpx.get(f"{self.address}/healthz", trust_env=False, timeout=30.0).is_success
        return False

    @contextmanager
    def crowd(self, what: str, count: int, clients: int = CLIENTS) -> Iterator[dict[str, int]]:
        """Have so many want something; gives what became of them."""
        command = [sys.executable, "-m", "tests.faults.crowd", self.address, what, str(count), str(clients)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                yield json.loads(process.stdout.readline())
            finally:
                process.kill()


@contextmanager
def loaded(
    repository: Path, folder: Path, endpoint: str, free_port: Callable[[], int], **settings: object
) -> Iterator[Loaded]:
    """Start drive and gateway, with settings of the gateway."""
    port = free_port()
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith(("GATEWAY_", "TOPNAV_"))},
        "TOPNAV_ENDPOINT": endpoint,
        "TOPNAV_LOG_LEVEL": "ERROR",
        "DRIVE_STATE_DIR": str(folder / "drive"),
        "GATEWAY_PORT": str(port),
        "GATEWAY_RUNS_DIR": str(folder / "runs"),
        **{f"GATEWAY_{name.upper()}": str(value) for name, value in settings.items()},
    }
    with contextlib.ExitStack() as stack:
        processes = [
            stack.enter_context(_process(name, repository, environment)) for name in ("drive", "gateway")
        ]
        running = Loaded(endpoint, f"http://127.0.0.1:{port}", processes[1].pid)
        assert wait_until(running.alive, START_S), "the gateway did not start"
        with open_bus(endpoint) as bus:
            assert wait_until(lambda: bus.alive("drive") == ["drive"], START_S), "drive did not start"
        yield running


@contextmanager
def _process(name: str, repository: Path, environment: dict[str, str]) -> Iterator["subprocess.Popen[bytes]"]:
    command = [sys.executable, "-m", "tests.patient", f"services.{name}"]
    with subprocess.Popen(command, cwd=repository, env=environment, stderr=subprocess.DEVNULL) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(10.0)
            process.kill()


def measure(running: Loaded, during_s: float) -> dict[str, float]:
    """Command latencies without load, beside stalled uploads, without load again, and beside readers."""
    figures: dict[str, float] = {}
    with Stopwatch(running.endpoint) as watch:
        assert watch.warm_up(), "drive does not answer"
        idle_s = watch.latencies_s(during_s)
        with running.crowd("stall", STALLED) as outcome:
            assert outcome == {"in": STALLED}
            figures |= _beside(running, watch, during_s, "stalled")
            figures["stalled_read_ms"] = _reading_ms(running)
        idle_s += watch.latencies_s(during_s)
        with running.crowd("read", READERS) as outcome:
            assert outcome == {"in": READERS}
            figures |= _beside(running, watch, during_s, "readers")
            figures["readers_read_ms"] = _reading_ms(running)
        figures["gateway_mb"] = round(memory_mb(running.pid, RESIDENT), 1)
    figures |= told(idle_s, "idle")
    for name in ("stalled", "readers"):
        figures[f"{name}_ratio"] = round(figures[f"{name}_p99_ms"] / figures["idle_p99_ms"], 2)
    return figures


def _beside(running: Loaded, watch: Stopwatch, during_s: float, name: str) -> dict[str, float]:
    """Latencies, and the share of one processor that the gateway takes meanwhile."""
    began_s, used_s = time.monotonic(), _processor_s(running.pid)
    figures = told(watch.latencies_s(during_s), name)
    share = (_processor_s(running.pid) - used_s) / (time.monotonic() - began_s)
    return figures | {f"{name}_processor": round(share, 3)}


def _processor_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _reading_ms(running: Loaded) -> float:
    """How long the gateway takes to answer a request meanwhile."""
    began_s = time.monotonic()
    assert running.alive()
    return round(1e3 * (time.monotonic() - began_s), 1)
