"""Durations of stages, and the latency from frame to command, from hand-made arrivals."""

import numpy as np
import pytest

from experiments.bench.stages import Arrival, latency, stage_durations_ms, table
from shared.messages.drive import Heading, Velocity
from shared.messages.features import Features
from shared.messages.missions import Event, EventValue
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose, Truth

POSE = Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0)


def features(seq):
    arrays = {"lonlat_rad": np.zeros((1, 2), np.float32), "scores": np.zeros(1, np.float32)}
    return Features(seq=seq, stamp_ns=seq, pipeline="p", descriptors=np.zeros((1, 4), np.uint8), **arrays)


def cycle(seq, start_s):
    return [
        Arrival(
            "truth", start_s, Truth(seq=seq, stamp_ns=seq, robot="r1", world="w", pose=POSE, render_ms=60)
        ),
        Arrival("features", start_s + 0.050, features(seq)),
        Arrival("heading", start_s + 0.080, Heading(seq=seq, stamp_ns=seq, robot="r1")),
        Arrival("command", start_s + 0.081, Velocity(seq=seq, stamp_ns=seq, robot="r1")),
    ]


def test_stages_follow_from_the_arrivals_of_one_frame_and_the_next():
    values = (EventValue(name="match_ms", value=5.0), EventValue(name="verify_ms", value=10.0))
    event = Arrival("event", 0.08, Event(seq=9, stamp_ns=1, robot="r1", kind="heading", values=values))
    found = stage_durations_ms([*cycle(1, 0.0), event, *cycle(2, 0.150)])
    expected = {"render": 60.0, "extract": 50.0, "match": 5.0, "verify": 10.0, "plan": 15.0, "drive": 1.0}
    for stage, duration_ms in (expected | {"simulate": 9.0}).items():
        assert found[stage] == pytest.approx([duration_ms]), stage


def test_a_repeated_message_does_not_move_its_first_arrival():
    again = Arrival("features", 0.070, features(1))
    assert stage_durations_ms([*cycle(1, 0.0), again, *cycle(2, 0.2)])["plan"] == pytest.approx([30.0])


def test_a_command_that_overtook_its_heading_took_no_time():
    *others, command = cycle(1, 0.0)
    overtaking = Arrival("command", 0.079, command.message)
    assert stage_durations_ms([*others, overtaking, *cycle(2, 0.2)])["drive"] == [0.0]


def test_a_cycle_that_lacks_a_message_is_left_out():
    assert stage_durations_ms([*cycle(1, 0.0)[:-1], *cycle(2, 0.2)])["drive"] == []


def test_table_leaves_out_what_nobody_measured():
    assert table({"render": [1.0, 3.0], "match": []}) == {"render": {"p50_ms": 2.0, "p99_ms": 2.98}}


def heard(frames, commands):
    """Arrivals of frames and commands at these seconds, by number."""
    picture = {"encoding": "bgr8", "width_px": 2, "height_px": 1, "data": bytes(6)}
    messages = [("frame", s, Frame(seq=k, robot="r1", **picture)) for k, s in frames.items()]
    messages += [("command", s, Velocity(seq=k, robot="r1")) for k, s in commands.items()]
    return [Arrival(*message) for message in messages]


def test_waits_are_those_of_frames_that_got_a_command():
    frames = {k: 10.0 + 0.2 * k for k in range(6)}
    commands = {1: frames[1] + 0.1, 2: frames[2] + 0.1, 4: frames[4] + 0.3}
    found = latency(heard(frames, commands))
    assert found["p50_ms"] == pytest.approx(100.0)
    assert found["p99_ms"] == pytest.approx(296.0)
    assert found["frames"] == 4  # 1 to 4: before and after them nothing drives
    assert found["answered"] == pytest.approx(0.75)


def test_of_a_repeated_frame_and_command_the_first_counts():
    again = heard({1: 5.0}, {1: 6.0})
    assert latency([*heard({1: 1.0}, {1: 1.1}), *again])["p50_ms"] == pytest.approx(100.0)


@pytest.mark.parametrize(("frames", "count"), [({}, 0), ({1: 1.0}, 0)])
def test_without_commands_there_is_no_figure(frames, count):
    assert latency(heard(frames, {})) == {"frames": count}


def test_commands_for_frames_nobody_saw_give_no_figure():
    assert latency(heard({}, {3: 1.0})) == {"frames": 0}
