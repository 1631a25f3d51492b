"""`topnav foxglove` says what it wrote and what not, and shows the true pose as what it is."""

import math
import struct
import sys

import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

from services.launcher import cli
from services.launcher.commands.recordings.foxglove import app
from services.recorder.backlog import Sample
from services.recorder.recording import RecordingWriter
from shared.messages.missions import MissionStatus
from shared.messages.simulation import Pose, Truth
from shared.wire import encode

POSE = Pose(x_m=1.5, y_m=-2.0, yaw_rad=0.8)


@pytest.fixture
def recording(tmp_path):
    """A simulated robot that stands still; the last message is none."""
    path = tmp_path / "a.mcap"
    truth = Truth(robot="r1", stamp_ns=5, world="flat", pose=POSE, hider=POSE)
    with RecordingWriter(path) as writer:
        for k, (key, payload) in enumerate(
            [("truth", encode(truth)), ("status", encode(MissionStatus(robot="r1"))), ("status", b"?")]
        ):
            writer.write(Sample(f"topnav/r1/{key}", payload, 1_000 + k))
    return path


def run(recording, out):
    return CliRunner().invoke(app, [str(recording), str(out)], catch_exceptions=False)


def test_the_true_pose_is_a_transform_of_the_simulation_only(recording, tmp_path):
    assert run(recording, tmp_path / "b.mcap").exit_code == 0
    with (tmp_path / "b.mcap").open("rb") as stream:
        found = {c.topic: (s.name, m.data) for s, c, m in make_reader(stream).iter_messages()}
    kind, data = found["topnav/r1/truth/simulation only"]
    assert kind == "foxglove.FrameTransform"
    assert b"flat (simulation only)" in data
    for value in (POSE.x_m, POSE.y_m, math.sin(0.4), math.cos(0.4)):
        assert struct.pack("<d", value) in data
    kind, data = found["topnav/r1/truth/simulation only/hider"]
    assert kind == "foxglove.PoseInFrame"
    assert b"flat (simulation only)" in data
    assert found["topnav/r1/truth"][0] == "truth.v1"


def test_it_says_what_was_written_and_what_left_out(recording, tmp_path):
    said = run(recording, tmp_path / "b.mcap").stdout
    assert "topnav/r1/truth/simulation only" in said
    assert "left out: 1 of topnav/r1/status" in said
    assert "ends early" not in said


def test_it_says_where_a_broken_recording_ends(recording, tmp_path):
    recording.write_bytes(recording.read_bytes()[:-40])
    result = run(recording, tmp_path / "b.mcap")
    assert result.exit_code == 0
    assert "ends early" in result.stdout


@pytest.mark.parametrize("missing", [True, False])
def test_what_users_can_mend_is_one_line(recording, tmp_path, monkeypatch, capsys, missing):
    out = tmp_path / "b.mcap"
    if missing:
        monkeypatch.setitem(sys.modules, "foxglove", None)
        monkeypatch.delitem(sys.modules, "services.recorder.foxglove.drawings", raising=False)
    else:
        out.touch()
    monkeypatch.setattr(sys, "argv", ["topnav", "foxglove", str(recording), str(out)])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert ("pip install 'topnav[foxglove]'" if missing else "exists already") in line
