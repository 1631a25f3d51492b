"""Robots that ask feature services at once are measured on real processes. Never gates on how fast it was."""

import numpy as np
import pytest

from experiments.scale.frames import Seen, WorldFrames
from experiments.scale.robots import Load, Work, measure_loads
from services.features.pipeline.interfaces import FeatureSet
from shared.messages.simulation import Pose

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

LOADS = [Load(robots=2, services=2), Load(robots=1, services=1, rate_hz=1.0)]


def seen(number):
    rng = np.random.default_rng(number)
    features = FeatureSet(
        rng.uniform(-0.5, 0.5, (100, 2)).astype(np.float32),
        np.ones(100, np.float32),
        rng.integers(0, 120, (100, 128)).astype(np.uint8),
    )
    return Seen("apartment", 0.6, Pose(x_m=1.3 + 0.2 * number, y_m=1.3, yaw_rad=0.0), features)


def test_each_load_gives_a_row_with_rate_waiting_and_processor_time(tmp_path):
    frames = WorldFrames(nodes=[seen(n) for n in range(6)], queries=[seen(n) for n in range(2)])
    told = []
    rows = list(measure_loads(LOADS, Work(frames, "sift", tmp_path, during_s=6.0), told.append))
    assert [(row["robots"], row["services"], row["rate_hz"]) for row in rows] == [(2, 2, 0.0), (1, 1, 1.0)]
    for row in rows:
        assert 0.0 < row["p50_ms"] <= row["p99_ms"]
        assert row["cpu_ms_per_frame"] > 1.0
    assert rows[0]["frames_per_s"] > 0.0
    assert 0.0 < rows[1]["frames_per_s"] <= 1.4, "no more often than asked"
    assert len(told) == 1 + len(LOADS)
