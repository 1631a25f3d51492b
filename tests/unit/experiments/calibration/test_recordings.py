"""Pairs of frames of a recorded drive, told by its commands alone."""

import math

import numpy as np
import pytest

from experiments.calibration.recordings import stops_of, straight_pairs
from services.recorder.backlog import Sample
from services.recorder.recording import RecordingWriter
from shared.messages.drive import Velocity
from shared.messages.sensors import Frame
from shared.wire import encode

STEP_M = 0.12
PERIOD_NS = 200_000_000


def frame(seq):
    sent = Frame(
        robot="r1",
        seq=seq,
        stamp_ns=1 + seq * PERIOD_NS,
        encoding="bgr8",
        width_px=2,
        height_px=1,
        data=bytes(6),
    )
    return Sample("topnav/r1/frame", encode(sent), seq)


def command(robot, seq, way_rad):
    speed_mps = STEP_M / (1e-9 * PERIOD_NS)
    stamp_ns = 1 + seq * PERIOD_NS
    sent = Velocity(
        robot=robot,
        seq=seq,
        stamp_ns=stamp_ns,
        at_ns=stamp_ns,
        forward_mps=speed_mps * math.cos(way_rad),
        left_mps=speed_mps * math.sin(way_rad),
    )
    return Sample(f"topnav/{robot}/velocity", encode(sent), seq)


@pytest.fixture
def recording(tmp_path):
    """Ten steps ahead, ten to the left; another robot goes back."""
    path = tmp_path / "drive.mcap"
    with RecordingWriter(path) as writer:
        for seq in range(21):
            writer.write(frame(seq))
            writer.write(command("r1", seq, 0.0 if seq < 10 else math.pi / 2))
            writer.write(command("r2", seq, math.pi))
    return path


def test_commands_tell_where_frames_were_taken(recording):
    stops = stops_of(recording)
    assert len(stops) == 21
    assert stops[10].position_m == pytest.approx((10 * STEP_M, 0.0))
    assert stops[20].position_m == pytest.approx((10 * STEP_M, 10 * STEP_M))
    assert stops[20].driven_m == pytest.approx(20 * STEP_M)


def test_only_straight_ways_make_pairs(recording):
    pairs = straight_pairs(stops_of(recording), 1000, (0.3, 3.0), np.random.default_rng(1))
    assert max(math.dist(a.position_m, b.position_m) for a, b in pairs) < 1.6
    assert all(
        b.driven_m - a.driven_m <= 1.1 * math.dist(a.position_m, b.position_m) + 1e-9 for a, b in pairs
    )
    assert {a.number for a, _ in pairs} >= {0, 17}
    assert len(straight_pairs(stops_of(recording), 20, (0.3, 3.0), np.random.default_rng(1))) == 20
