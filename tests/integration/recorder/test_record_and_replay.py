"""A real bus: what is said is recorded, survives kill -9, and is said again under another name."""

import os
import subprocess
import sys
import threading
import time
from collections import Counter

import pytest

from services.recorder.channels import RecordingError
from services.recorder.player import Player, play
from services.recorder.reading import contents, read
from services.recorder.recorder import record
from services.recorder.recording import RecordingWriter, recover
from shared.bus import open_bus, wait_until
from shared.messages.sensors import Frame, Ranges
from shared.topics import FRAME, RANGES, TRUTH
from shared.wire import decode

SOON_S = 30.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


def ranges(seq):
    return Ranges(robot="r1", seq=seq, angles_rad=(0.0,) * 12, distances_m=(1.0,) * 12, max_range_m=4.0)


def frame(seq):
    return Frame(robot="r1", seq=seq, encoding="bgr8", width_px=4, height_px=2, data=bytes([seq] * 24))


@pytest.fixture
def buses(router_endpoint):
    with open_bus(router_endpoint) as speaker, open_bus(router_endpoint) as listener:
        yield speaker, listener


def talk(bus, count=20):
    """Say something; whoever taps the bus hears all of it."""
    distances, frames = bus.publisher(RANGES, robot="r1"), bus.publisher(FRAME, robot="r1")
    for seq in range(count):
        distances.put(ranges(seq))
        frames.put(frame(seq))
        time.sleep(0.005)


def recorded(buses, path, without=()):
    speaker, listener = buses
    stop, wanted = threading.Event(), {"topnav/r1/ranges", "topnav/r1/frame"}
    wanted -= {f"topnav/r1/{name}" for name in without}
    with RecordingWriter(path) as writer:
        thread = threading.Thread(target=record, args=(listener, writer, without, stop, None))
        thread.start()
        try:
            assert wait_until(lambda: "recorder" in speaker.alive(), SOON_S)
            talk(speaker)
            assert wait_until(lambda: all(writer.counts[key] >= 20 for key in wanted), SOON_S)
        finally:
            stop.set()
            thread.join()
    return path


def reached(bus, heard):
    """Until a tap on distances hears this session: what is said before that is lost to it."""
    probe = bus.publisher(RANGES, robot="probe")
    assert wait_until(lambda: (probe.put(ranges(0)), heard["topnav/probe/ranges"] > 0)[1], SOON_S)


def test_everything_that_is_said_is_in_the_file(buses, tmp_path):
    path = recorded(buses, tmp_path / "a.mcap")
    said = [decode(Frame, s.payload, 1000) for s in read(path) if s.key == "topnav/r1/frame"]
    assert said == [frame(seq) for seq in range(20)]
    assert contents(path).counts == {"topnav/r1/ranges": 20, "topnav/r1/frame": 20}


def test_topics_can_be_left_out(buses, tmp_path):
    path = recorded(buses, tmp_path / "a.mcap", without=("frame",))
    assert contents(path).counts == {"topnav/r1/ranges": 20}


def test_a_replay_says_it_again_under_another_name(buses, tmp_path):
    path = recorded(buses, tmp_path / "a.mcap")
    speaker, listener = buses
    heard, said = Counter(), []
    listener.tap(TRUTH, lambda key, _: heard.update([key]))
    listener.tap(RANGES, lambda key, payload: (said.append((key, payload)), heard.update([key])))
    reached(speaker, heard)
    player = Player(speaker, {"r1": "ghost"}, without=("frame",))
    play(read(path), player.put, 2.0, threading.Event())
    assert wait_until(lambda: heard["topnav/ghost/ranges"] == 20, SOON_S)
    assert set(heard) == {"topnav/ghost/ranges", "topnav/probe/ranges"}
    renamed = [payload for key, payload in said if key == "topnav/ghost/ranges"]
    assert {decode(Ranges, payload, 1000).robot for payload in renamed} == {"ghost"}


def test_a_killed_recorder_loses_a_second_at_most(buses, router_endpoint, tmp_path):
    speaker, _ = buses
    path, saved = tmp_path / "a.mcap", tmp_path / "saved.mcap"
    variables = {"TOPNAV_ENDPOINT": router_endpoint, "RECORDER_FILE": str(path)}
    process = subprocess.Popen(
        [sys.executable, "-m", "services.recorder"],
        env={**os.environ, **variables},
        stderr=subprocess.DEVNULL,
    )

    def on_disk():
        saved.unlink(missing_ok=True)
        try:
            return recover(path, saved).messages
        except RecordingError:  # nothing yet
            return 0

    try:
        assert wait_until(lambda: "recorder" in speaker.alive(), SOON_S)
        for _ in range(3):  # what else this machine does only ever adds to the time: one of them is enough
            wanted = on_disk() + 40
            talk(speaker)
            if wait_until(lambda: on_disk() >= wanted, 5.0):  # noqa: B023
                break
        else:
            pytest.fail("nothing was on disk soon after it was said")
    finally:
        process.kill()
        process.wait()
    assert on_disk() >= wanted
