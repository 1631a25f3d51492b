"""The HTTP examples of the README, line by line against the gateway and its stand-in neighbours."""

import os
import shutil
import subprocess

import httpx
import pytest

from shared.bus import Bus, wait_until
from shared.topics import FRAME
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.test_robots import frame
from tests.readme import examples

pytestmark = pytest.mark.skipif(shutil.which("curl") is None, reason="the examples are written with curl")

STRICT = 'set -euo pipefail; curl() { command curl --silent --show-error --fail-with-body "$@"; }\n'


@pytest.mark.usefixtures("map_store")
def test_every_line_answers(http: httpx.Client, gateway: str, robot_bus: Bus, tmp_path) -> None:
    publisher = robot_bus.publisher(FRAME, robot="r1")

    def arrived() -> bool:
        publisher.put(frame("r1", 42))
        return http.get("/api/robots/r1/frame.jpg").status_code == 200

    assert wait_until(arrived, WAIT_S)
    answer = subprocess.run(
        ["bash", "-c", STRICT + examples("bash")[0]],
        env={**os.environ, "TOPNAV_URL": gateway, "no_proxy": "127.0.0.1"},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=150,
    )
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert '"state":"cancelled"' in answer.stdout
    assert (tmp_path / "frame.jpg").read_bytes().startswith(b"\xff\xd8")
    assert (tmp_path / "node.jpg").read_bytes() == b"jpeg"
    assert (tmp_path / "flat.zip").read_bytes().startswith(b"PK")
