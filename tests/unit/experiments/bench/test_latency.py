"""Frame to command: which frames count, and what is reported without any."""

import pytest

from experiments.bench.latency import latency


def test_waits_are_those_of_frames_that_got_a_command():
    frames = {k: 10.0 + 0.2 * k for k in range(6)}
    commands = {1: frames[1] + 0.1, 2: frames[2] + 0.1, 4: frames[4] + 0.3}
    found = latency(frames, commands)
    assert found["p50_ms"] == pytest.approx(100.0)
    assert found["p99_ms"] == pytest.approx(296.0)
    assert found["frames"] == 4  # 1 to 4: before and after them nothing drives
    assert found["answered"] == pytest.approx(0.75)


@pytest.mark.parametrize(("frames", "count"), [({}, 0), ({1: 1.0}, 0)])
def test_without_commands_there_is_no_figure(frames, count):
    assert latency(frames, {}) == {"frames": count}


def test_commands_for_frames_nobody_saw_give_no_figure():
    assert latency({}, {3: 1.0}) == {"frames": 0}
