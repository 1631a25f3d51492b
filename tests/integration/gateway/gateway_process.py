"""The gateway as a process of its own, as tests of what it takes and leaves behind need it."""

import os
import subprocess
import sys
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import httpx

from services.launcher.processes.free_ports import free_ports
from shared.bus import wait_until
from tests.integration.gateway.corpus import LIMIT_BYTES

ROOT = Path(__file__).resolve().parents[3]

UNHURRIED = {
    name: 10_000
    for name in (
        "writes_per_s",
        "write_burst",
        "uploads_per_s",
        "upload_burst",
        "comparisons_per_s",
        "comparison_burst",
        "failure_burst",
    )
}
"""No rate limits: tests ask faster than people and programs do."""

WAIT_S = 30.0
"""For busy machines, where all may stand still for seconds: what is waited for is there at once elsewhere."""
ASK_S = 2 * WAIT_S
"""So long the gateway waits for a neighbour: one that is slow for a while is no missing service to a test."""


def free_port() -> int:
    """A port that is free now and that nobody gets by chance before the gateway listens there."""
    return free_ports(1)[0]


def answers(address: str) -> bool:
    """Whether somebody serves there."""
    try:
        return httpx.get(f"{address}/healthz", trust_env=False, timeout=WAIT_S).status_code == 200
    except httpx.HTTPError:
        return False


def sees(address: str, services: Collection[str]) -> bool:
    """Whether a gateway serves there that has met these services: what it asks them will arrive."""
    try:
        answer = httpx.get(f"{address}/readyz", trust_env=False, timeout=WAIT_S)
    except httpx.HTTPError:
        return False
    return set(services) <= answer.json()["services"].keys()


@dataclass
class Process:
    """The gateway as a process."""

    address: str
    pid: int
    folder: Path
    process: "subprocess.Popen[bytes]"

    def rss_bytes(self) -> int:
        """Memory it has now."""
        return int(Path(f"/proc/{self.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def files(self) -> list[str]:
        """What lies in its working and temporary folder."""
        return sorted(str(path) for path in self.folder.rglob("*"))

    def end(self) -> None:
        """Stop it as a supervisor does; it must end well."""
        self.process.terminate()
        try:
            assert self.process.wait(WAIT_S) == 0
        finally:
            self.process.kill()


def started(endpoint: str, folder: Path, beside: Collection[str] = ()) -> Process:
    """Start one whose files go to `folder`, and wait until it serves and has met the services `beside` it."""
    port = free_port()
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith(("GATEWAY_", "TOPNAV_"))},
        "TOPNAV_ENDPOINT": endpoint,
        "GATEWAY_PORT": str(port),
        "GATEWAY_MAX_UPLOAD_BYTES": str(LIMIT_BYTES),
        "GATEWAY_ASK_TIMEOUT_S": str(ASK_S),
        **{f"GATEWAY_{name.upper()}": str(value) for name, value in UNHURRIED.items()},
        "PYTHONPATH": str(ROOT),
        "TMPDIR": str(folder),
    }
    command = [sys.executable, "-m", "tests.patient", "services.gateway"]
    process = subprocess.Popen(command, cwd=folder, env=environment)
    address = f"http://127.0.0.1:{port}"
    if not wait_until(lambda: sees(address, beside), 2 * WAIT_S):
        process.kill()
        raise AssertionError(f"no gateway that has met {list(beside)} at {address}: see its log")
    return Process(address, process.pid, folder, process)


def send(
    process: Process, content_type: str, body: bytes, robot: str = "r1", name: str = "flat"
) -> httpx.Response:
    """Have a goal picture checked."""
    url = f"{process.address}/api/robots/{robot}/goal-check?map={name}"
    headers = {"content-type": content_type} if content_type else {}
    return httpx.post(url, content=body, headers=headers, trust_env=False, timeout=ASK_S)
