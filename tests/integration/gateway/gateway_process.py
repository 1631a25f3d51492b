"""The gateway as a process of its own, as tests of what it takes and leaves behind need it."""

import os
import socket
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import httpx

from shared.bus import wait_until
from tests.integration.gateway.corpus import LIMIT_BYTES

ROOT = Path(__file__).resolve().parents[3]

UNHURRIED = {
    name: 10_000 for name in ("writes_per_s", "write_burst", "uploads_per_s", "upload_burst", "failure_burst")
}
"""No rate limits: tests ask faster than people and programs do."""


def free_port() -> int:
    """A port that was free a moment ago."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def answers(address: str) -> bool:
    """Whether somebody serves there."""
    try:
        return httpx.get(f"{address}/healthz", trust_env=False).status_code == 200
    except httpx.HTTPError:
        return False


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


def started(endpoint: str, folder: Path) -> Process:
    """Start one whose files go to `folder`, and wait for it."""
    port = free_port()
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith(("GATEWAY_", "TOPNAV_"))},
        "TOPNAV_ENDPOINT": endpoint,
        "GATEWAY_PORT": str(port),
        "GATEWAY_MAX_UPLOAD_BYTES": str(LIMIT_BYTES),
        **{f"GATEWAY_{name.upper()}": str(value) for name, value in UNHURRIED.items()},
        "PYTHONPATH": str(ROOT),
        "TMPDIR": str(folder),
    }
    process = subprocess.Popen([sys.executable, "-m", "services.gateway"], cwd=folder, env=environment)
    address = f"http://127.0.0.1:{port}"
    assert wait_until(lambda: answers(address), 20.0)
    return Process(address, process.pid, folder, process)


def send(
    process: Process, content_type: str, body: bytes, robot: str = "r1", name: str = "flat"
) -> httpx.Response:
    """Have a goal picture checked."""
    url = f"{process.address}/api/robots/{robot}/goal-check?map={name}"
    headers = {"content-type": content_type} if content_type else {}
    return httpx.post(url, content=body, headers=headers, trust_env=False, timeout=30.0)
