"""`topnav replay` shows a recording on a web page of its own and never mixes it with a living robot."""

import re
import subprocess
import sys

import httpx
import pytest

from services.recorder.backlog import Sample
from services.recorder.recording import RecordingWriter
from shared.bus import open_bus, wait_until
from shared.messages.missions import MissionStatus
from shared.messages.sensors import Frame
from shared.wire import encode

SOON_S, RUN_S, TRIES = 60.0, 120.0, 3

pytestmark = pytest.mark.usefixtures("patient_sessions")


@pytest.fixture
def recording(tmp_path):
    """Two seconds of a robot that explores."""
    path = tmp_path / "walk.mcap"
    with RecordingWriter(path) as writer:
        for k in range(20):
            frame = Frame(
                robot="r1", seq=k, encoding="bgr8", width_px=64, height_px=32, data=bytes(64 * 32 * 3)
            )
            status = MissionStatus(robot="r1", action="explore", map="flat", state="running", step=k)
            for key, message in (("topnav/r1/frame", frame), ("topnav/r1/status", status)):
                writer.write(Sample(key, encode(message), 1_000_000_000 + k * 100_000_000))
    return path


def topnav(*words):
    return subprocess.Popen(
        [sys.executable, "-m", "services.launcher", *map(str, words)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_the_page_shows_the_recorded_robot(recording, tmp_path):
    process = topnav("replay", recording, "--loop", "--data-dir", tmp_path / "data")
    try:
        found = re.search(r"console (http://\S+)", process.stderr.readline())
        assert found is not None
        with httpx.Client(base_url=f"{found[1]}/api", trust_env=False, timeout=SOON_S) as api:
            assert wait_until(lambda: api.get("/robots/r1/frame.jpg").status_code == 200, SOON_S)
            assert wait_until(lambda: api.get("/robots/r1").json()["mission"] is not None, SOON_S)
            assert api.get("/robots/r1").json()["mission"]["action"] == "explore"
    finally:
        process.terminate()
        _, errors = process.communicate(timeout=RUN_S)
    assert process.returncode == 0, errors


def test_a_recorded_robot_is_not_mixed_with_a_living_one(recording, router_endpoint):
    with open_bus(router_endpoint) as bus:
        bus.announce("simulator")
        for _ in range(TRIES):  # it looks for two seconds: a slow machine may have shown it nobody by then
            process = topnav("replay", recording, "--endpoint", router_endpoint)
            _, errors = process.communicate(timeout=RUN_S)
            if process.returncode == 1:
                break
        assert process.returncode == 1
        assert "simulator live here" in errors
        assert "--remap r1=ghost" in errors
        process = topnav(
            "replay", recording, "--endpoint", router_endpoint, "--remap", "r1=ghost", "--rate", 10
        )
        _, errors = process.communicate(timeout=RUN_S)
        assert process.returncode == 0, errors


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--remap", "r1"], "old=new"),
        (["--remap", "r1=maps"], "old=new"),
        (["--without", "pictures"], "got pictures"),
    ],
)
def test_wrong_options_are_one_line(recording, words, message):
    process = topnav("replay", recording, *words)
    _, errors = process.communicate(timeout=RUN_S)
    assert process.returncode == 1
    assert message in errors
    assert len(errors.strip().splitlines()) == 1
