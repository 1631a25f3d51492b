"""Frames that come twice, late or in the wrong order: each is answered once, none after a newer one."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest

from shared.bus import open_bus, wait_until
from shared.messages.sensors import Frame
from shared.topics import FEATURES, FRAME

pytestmark = [pytest.mark.usefixtures("patient_sessions")]

START_S = 60.0
WARM_UP = 0
"""Number of a frame that is sent until its answer comes: from then on each side hears the other."""
DISORDER = (1, 2, 2, 3, 2, 1, 5, 4, 3, 6, 6, 1, 8, 7, 9)
ANSWER_S = 20.0
QUIET_S = 0.4


@pytest.fixture
def features(router_endpoint):
    """The feature service as a process."""
    command = [sys.executable, "-m", "tests.patient", "services.features"]
    process = subprocess.Popen(command, env=os.environ | {"TOPNAV_ENDPOINT": router_endpoint})
    yield process
    process.kill()
    process.wait()


def picture(seq, stamp_ns):
    pixels = np.random.default_rng(seq).integers(0, 255, (64, 128, 3), np.uint8)
    return Frame(robot="r1", seq=seq, stamp_ns=stamp_ns, encoding="bgr8", width_px=128, height_px=64,
                 data=pixels.tobytes())  # fmt: skip


@pytest.fixture
def camera(router_endpoint, features):  # noqa: ARG001 - the service must run
    """Sends a frame and says which frame's features came of it, None when none did."""
    with open_bus(router_endpoint) as bus:
        assert wait_until(lambda: bus.alive("features") == ["features"], START_S)
        frames, results = bus.publisher(FRAME, robot="r1"), bus.subscribe(FEATURES, robot="r1")

        def answer(patience_s):
            deadline_s = time.monotonic() + patience_s
            while (found := results.wait(deadline_s - time.monotonic())) is not None:
                if found.seq != WARM_UP:
                    return found.seq
            return None

        def send(seq, stamp_ns, patience_s):
            frames.put(picture(seq, stamp_ns))
            return answer(patience_s)

        def heard():
            frames.put(picture(WARM_UP, 1))
            return results.wait(QUIET_S) is not None

        assert wait_until(heard, START_S)
        yield send


def test_late_frames_are_dropped_and_the_newest_said_twice_is_no_new_one(camera):
    began_ns, newest = time.time_ns(), 0
    for seq in DISORDER:
        answer = camera(seq, began_ns + seq * 10**8, ANSWER_S if seq >= newest else QUIET_S)
        newest = max(newest, seq)
        assert answer == (newest if seq == newest else None), f"frame {seq}, newest {newest}"


@pytest.mark.parametrize("hours", [1, -1], ids=["ahead", "back"])
def test_a_camera_clock_that_jumps_loses_no_frame(camera, hours):
    began_ns = time.time_ns()
    for seq in range(1, 7):
        shift_ns = hours * 3600 * 10**9 if seq > 3 else 0
        assert camera(seq, began_ns + seq * 10**8 + shift_ns, ANSWER_S) == seq
