"""An export for Foxglove holds what the recording holds, in schemas that Foxglove draws and plots."""

import io
import json
import math
import struct
import subprocess
import sys
from typing import ClassVar

import jsonschema
import numpy as np
import pytest
from mcap.reader import make_reader
from PIL import Image

from services.recorder.backlog import Sample
from services.recorder.channels import RecordingError
from services.recorder.foxglove.export import export
from services.recorder.foxglove.plain_json import plain_json, plain_schema
from services.recorder.recording import RecordingWriter, recover
from shared.messages.base import Message
from shared.messages.drive import Heading, Velocity
from shared.messages.features import Features
from shared.messages.maps import AddNode, MapDelta, Node, PutEdge
from shared.messages.missions import Event, EventValue, MissionStatus
from shared.messages.sensors import Frame, Ranges
from shared.topics import TOPICS
from shared.wire import encode
from tests.protobuf_fields import fields

WIDTH, HEIGHT = 64, 32
STAMP_NS = 1_700_000_000_250_000_000
ARRIVED_NS = STAMP_NS + 40_000_000
STEP_NS = 100_000_000


def doubles(packed):
    return list(struct.unpack(f"<{len(packed) // 8}d", packed))


def stamp_of(field):
    parts = fields(field)
    return parts[1][0] * 10**9 + parts.get(2, [0])[0]


def yaw_of(pose):
    turn = fields(fields(pose)[2][0])
    return 2 * math.atan2(turn.get(3, [0.0])[0], turn.get(4, [0.0])[0])


def frame(seq, **changes):
    picture = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    picture[..., 0], picture[:, : WIDTH // 2, 2] = 200, 250  # blue all over, red on the left
    plain = {"encoding": "bgr8", "width_px": WIDTH, "height_px": HEIGHT, "data": picture.tobytes()}
    return Frame(**{"robot": "r1", "seq": seq, "stamp_ns": STAMP_NS + seq * STEP_NS, **plain, **changes})


def ranges(first_deg=-30.0):
    """Twelve distances, each as many metres as its angle has degrees, divided by 100."""
    degrees = [first_deg + 30 * k for k in range(12)]
    return Ranges(
        robot="r1",
        stamp_ns=STAMP_NS,
        angles_rad=tuple(math.radians(d) for d in degrees),
        distances_m=tuple(d % 360 / 100 for d in degrees),
        max_range_m=4.0,
    )


def written(path, messages):
    """A recording of (key, message or bytes) a tenth of a second apart."""
    with RecordingWriter(path) as writer:
        for k, (key, message) in enumerate(messages):
            payload = message if isinstance(message, bytes) else encode(message)
            writer.write(Sample(f"topnav/{key}", payload, ARRIVED_NS + k * STEP_NS))
    return path


def exported(tmp_path, messages):
    """Export messages and read them back: channel -> [(schema, message)]."""
    export(written(tmp_path / "a.mcap", messages), tmp_path / "b.mcap")
    return read_back(tmp_path / "b.mcap")


def read_back(path):
    found = {}
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            found.setdefault(channel.topic, []).append((schema, channel, message))
    return found


def only(channels, name):
    ((schema, _, message),) = channels[name]
    return schema.name, message


def walk():
    for seq in range(5):
        yield "r1/frame", frame(seq)
        yield "r1/ranges", ranges()
        yield "r1/heading", Heading(robot="r1", seq=seq, heading_rad=0.5, s_cv=10 * seq)
        yield "r1/velocity", Velocity(robot="r1", seq=seq, forward_mps=0.35, left_mps=0.19)
        yield "r1/status", MissionStatus(robot="r1", step=seq, similarity=7)
        yield "r1/event", Event(robot="r1", step=seq, kind="heading", reason="to node 3")


def test_every_message_is_there_as_json_and_as_what_foxglove_draws(tmp_path):
    found = exported(tmp_path, walk())
    schemas = {name: {one[0].name for one in messages} for name, messages in found.items()}
    assert schemas == {
        "topnav/r1/frame": {"frame.v1"},
        "topnav/r1/frame/image": {"foxglove.CompressedImage"},
        "topnav/r1/ranges": {"ranges.v1"},
        "topnav/r1/ranges/scan": {"foxglove.LaserScan"},
        "topnav/r1/heading": {"heading.v1"},
        "topnav/r1/heading/arrow": {"foxglove.SceneUpdate"},
        "topnav/r1/velocity": {"velocity.v1"},
        "topnav/r1/velocity/arrow": {"foxglove.SceneUpdate"},
        "topnav/r1/status": {"mission_status.v1"},
        "topnav/r1/event": {"event.v1"},
        "topnav/r1/event/log": {"foxglove.Log"},
    }
    assert {len(messages) for messages in found.values()} == {5}
    for schema, channel, _ in (messages[0] for messages in found.values()):
        drawn = schema.name.startswith("foxglove.")
        expected = ("protobuf", "protobuf") if drawn else ("jsonschema", "json")
        assert (schema.encoding, channel.message_encoding) == expected


def test_log_times_are_those_of_the_recording_and_stamps_those_of_the_frames(tmp_path):
    found = exported(tmp_path, walk())
    for name in ("topnav/r1/frame", "topnav/r1/frame/image"):
        times = [message.log_time for _, _, message in found[name]]
        assert times == [ARRIVED_NS + 6 * k * STEP_NS for k in range(5)]
    stamps = [stamp_of(fields(m.data)[1][0]) for _, _, m in found["topnav/r1/frame/image"]]
    assert stamps == [STAMP_NS + k * STEP_NS for k in range(5)]


def test_a_message_that_belongs_to_no_frame_is_stamped_when_it_arrived(tmp_path):
    found = exported(tmp_path, [("r1/event", Event(robot="r1", kind="paused"))])
    _, message = only(found, "topnav/r1/event/log")
    assert stamp_of(fields(message.data)[1][0]) == message.log_time == ARRIVED_NS


def test_raw_frames_become_jpeg_of_the_same_size_and_colours(tmp_path):
    _, message = only(exported(tmp_path, [("r1/frame", frame(0))]), "topnav/r1/frame/image")
    image = fields(message.data)
    assert (image[3], image[4]) == ([b"jpeg"], [b"r1"])
    picture = Image.open(io.BytesIO(image[2][0]))
    assert (picture.format, picture.size) == ("JPEG", (WIDTH, HEIGHT))
    np.testing.assert_allclose(picture.getpixel((WIDTH // 4, 10)), (250, 0, 200), atol=12)
    np.testing.assert_allclose(picture.getpixel((3 * WIDTH // 4, 10)), (0, 0, 200), atol=12)


def test_jpeg_frames_pass_through(tmp_path):
    jpeg = frame(0, encoding="jpeg", data=b"\xff\xd8 as it came \xff\xd9")
    _, message = only(exported(tmp_path, [("r1/frame", jpeg)]), "topnav/r1/frame/image")
    assert fields(message.data)[2] == [jpeg.data]


@pytest.mark.parametrize("first_deg", [0.0, -150.0, -330.0, 15.0])
def test_each_distance_is_found_at_its_angle(tmp_path, first_deg):
    _, message = only(exported(tmp_path, [("r1/ranges", ranges(first_deg))]), "topnav/r1/ranges/scan")
    scan = fields(message.data)
    (start,), (end,), distances = scan[4], scan[5], doubles(scan[6][0])
    assert scan[2] == [b"r1"]
    assert -math.pi <= start < end <= math.pi + 1e-9
    angles = np.linspace(start, end, len(distances))  # as Foxglove reads a scan
    assert math.degrees(angles[1] - angles[0]) == pytest.approx(30.0)
    assert distances == pytest.approx([math.degrees(a) % 360 / 100 for a in angles])


def test_distances_at_uneven_angles_are_no_scan_but_numbers(tmp_path):
    uneven = ranges().model_copy(update={"angles_rad": (-0.3, *ranges().angles_rad[1:])})
    done = export(written(tmp_path / "a.mcap", [("r1/ranges", uneven)]), tmp_path / "b.mcap")
    assert done.counts == {"topnav/r1/ranges": 1}
    assert done.left_out == {
        "topnav/r1/ranges as a drawing": (1, "the angles of the distances have no constant step")
    }


@pytest.mark.parametrize(
    ("message", "yaw_rad", "length_m"),
    [
        (Heading(robot="r1", heading_rad=-0.7), -0.7, 1.0),
        (Velocity(robot="r1", forward_mps=0.4 * math.cos(0.3), left_mps=0.4 * math.sin(0.3)), 0.3, 0.5),
        (
            Velocity(robot="r1", forward_mps=-0.4 * math.cos(0.3), left_mps=-0.4 * math.sin(0.3)),
            0.3 - math.pi,
            0.5,
        ),
    ],
)
def test_an_arrow_points_where_the_robot_shall_go(tmp_path, message, yaw_rad, length_m):
    kind = type(message).__name__.lower()
    _, drawn = only(exported(tmp_path, [(f"r1/{kind}", message)]), f"topnav/r1/{kind}/arrow")
    entity = fields(fields(drawn.data)[2][0])
    assert (entity[2], entity[3]) == ([b"r1"], [f"r1 {kind}".encode()])
    arrow = fields(entity[7][0])
    turn = yaw_of(arrow[1][0])
    assert math.remainder(turn - yaw_rad, math.tau) == pytest.approx(0.0, abs=1e-9)
    assert arrow[2][0] + arrow[4][0] == pytest.approx(length_m)


@pytest.mark.parametrize("message", [Heading(robot="r1", action="hold"), Velocity(robot="r1")])
def test_a_robot_that_stands_still_has_no_arrow(tmp_path, message):
    kind = type(message).__name__.lower()
    _, drawn = only(exported(tmp_path, [(f"r1/{kind}", message)]), f"topnav/r1/{kind}/arrow")
    update = fields(drawn.data)
    assert 2 not in update
    assert fields(update[1][0])[3] == [f"r1 {kind}".encode()]


@pytest.mark.parametrize(
    ("kind", "level"),
    [
        ("heading", 1),
        ("node_added", 2),
        ("succeeded", 2),
        ("lost_mode", 3),
        ("edge_suspended", 3),
        ("travel_failed", 3),
        ("failed", 4),
    ],
)
def test_a_decision_is_a_line_of_the_log_with_its_level(tmp_path, kind, level):
    event = Event(robot="r1", kind=kind, reason="S 12 of 150")
    _, message = only(exported(tmp_path, [("r1/event", event)]), "topnav/r1/event/log")
    line = fields(message.data)
    assert (line[2], line[4]) == ([level], [b"r1"])
    assert line[3] == [f"{kind.replace('_', ' ')}: S 12 of 150".encode()]


def test_what_is_plotted_is_in_the_json(tmp_path):
    status = MissionStatus(robot="r1", step=4, similarity=31, nearest_node=None, disparity_rad=0.25)
    features = Features(
        pipeline="p",
        lonlat_rad=np.zeros((3, 2), np.float32),
        scores=np.zeros(3, np.float32),
        descriptors=np.zeros((3, 8), np.uint8),
        thumbnail=b"jpeg",
    )
    found = exported(tmp_path, [("r1/status", status), ("r1/features", features)])
    plain = json.loads(only(found, "topnav/r1/status")[1].data)
    assert (plain["step"], plain["similarity"], plain["disparity_rad"]) == (4, 31, 0.25)
    assert "nearest_node" not in plain
    keypoints = json.loads(only(found, "topnav/r1/features")[1].data)
    assert keypoints["descriptors"] == {"dtype": "uint8", "shape": [3, 8]}
    assert "thumbnail" not in keypoints


def foxglove_refuses(schema, path="message"):
    """Why Foxglove would not show a channel of this schema, as its parser of JSON Schema has it."""
    kind = schema.get("type")
    if kind == "object":
        return [why for name, one in schema["properties"].items() for why in foxglove_refuses(one, name)]
    if kind == "array":
        inner = schema["items"]
        return [f"{path}: list of lists"] if inner.get("type") == "array" else foxglove_refuses(inner, path)
    return [] if kind in {"boolean", "string", "number", "integer"} else [f"{path}: {schema}"]


@pytest.mark.parametrize("topic", TOPICS, ids=lambda topic: topic.message.SCHEMA)
def test_foxglove_accepts_the_schema_of_every_topic(topic):
    schema = json.loads(plain_schema(topic.message))
    assert schema["type"] == "object"
    assert {"seq", "stamp_ns"} <= schema["properties"].keys()
    assert foxglove_refuses(schema) == []


def test_the_schemas_of_pydantic_would_be_refused():
    assert foxglove_refuses(MissionStatus.model_json_schema())
    assert foxglove_refuses(Event.model_json_schema())


def test_fields_keep_their_types():
    fields_of = {topic.message: json.loads(plain_schema(topic.message))["properties"] for topic in TOPICS}
    assert fields_of[MissionStatus]["nearest_node"]["type"] == "integer"
    assert fields_of[MissionStatus]["via_points"]["items"] == {"type": "integer"}
    assert fields_of[Event]["values"]["items"]["properties"].keys() == {"name"}
    assert fields_of[Features]["scores"]["properties"]["shape"]["items"]["type"] == "integer"
    assert fields_of[Features]["scores"]["properties"]["dtype"]["type"] == "string"


def test_what_is_left_out_of_the_messages_is_not_declared():
    assert "data" not in json.loads(plain_schema(Frame))["properties"]
    assert "thumbnail" not in json.loads(plain_schema(Features))["properties"]


def test_a_list_of_lists_is_not_declared():
    class Grid(Message):
        SCHEMA: ClassVar[str] = "grid.v1"
        cells: tuple[tuple[int, ...], ...] = ()

    assert json.loads(plain_schema(Grid))["properties"].keys() == {"seq", "stamp_ns"}


def test_messages_fit_their_schemas():
    features = Features(
        pipeline="p",
        lonlat_rad=np.zeros((1, 2), np.float32),
        scores=np.zeros(1, np.float32),
        descriptors=np.zeros((1, 4), np.uint8),
    )
    operations = (AddNode(node=Node(node_id=3), features=features), PutEdge(edge={"a": 1, "b": 3}))
    values = tuple(EventValue(name="x", value=value) for value in (1, 0.5, "far", True, None))
    for message in (
        MapDelta(map="flat", revision=4, operations=operations),
        Event(robot="r1", kind="heading", values=values),
        MissionStatus(robot="r1"),
        features,
        ranges(),
        frame(0),
    ):
        jsonschema.validate(json.loads(plain_json(message)), json.loads(plain_schema(type(message))))


def test_two_exports_of_one_process_do_not_mix(tmp_path):
    walked = written(tmp_path / "a.mcap", walk())
    other = written(tmp_path / "other.mcap", [("r2/status", MissionStatus(robot="r2"))])
    for source, out in ((walked, "1"), (other, "2"), (walked, "3")):
        export(source, tmp_path / out)
    assert (tmp_path / "1").read_bytes() == (tmp_path / "3").read_bytes()
    assert set(read_back(tmp_path / "2")) == {"topnav/r2/status"}


def damage(path, tmp_path, how):
    whole = path.read_bytes()
    place = int(0.6 * len(whole))
    broken = tmp_path / "broken.mcap"
    flipped = bytes(byte ^ 255 for byte in whole[place : place + 50])
    broken.write_bytes(whole[:place] if how == "cut" else whole[:place] + flipped + whole[place + 50 :])
    return broken


@pytest.mark.parametrize("how", ["cut", "flipped"])
def test_of_a_damaged_recording_what_is_whole_is_exported(tmp_path, how):
    rng = np.random.default_rng(1)
    noise = [
        (
            "r1/frame",
            frame(k, encoding="jpeg", data=rng.integers(256, size=200_000, dtype=np.uint8).tobytes()),
        )
        for k in range(30)
    ]
    broken = damage(written(tmp_path / "a.mcap", noise), tmp_path, how)
    done = export(broken, tmp_path / "b.mcap")
    saved = recover(broken, tmp_path / "saved.mcap")
    assert done.problem == saved.problem != ""
    assert 10 <= saved.messages < 30
    assert done.counts == dict.fromkeys(["topnav/r1/frame", "topnav/r1/frame/image"], saved.messages)
    assert len(read_back(tmp_path / "b.mcap")["topnav/r1/frame/image"]) == saved.messages


def test_a_message_that_cannot_be_read_costs_no_other(tmp_path):
    status = MissionStatus(robot="r1")
    source = written(tmp_path / "a.mcap", [("r1/status", status), ("r1/status", b"?"), ("r1/status", status)])
    done = export(source, tmp_path / "b.mcap")
    assert done.counts == {"topnav/r1/status": 2}
    ((key, (count, reason)),) = done.left_out.items()
    assert (key, count) == ("topnav/r1/status", 1)
    assert "mission_status.v1" in reason


@pytest.mark.parametrize("content", [b"", b"no recording at all", bytes(1000)])
def test_what_is_no_recording_is_refused_and_leaves_no_file(tmp_path, content):
    source = tmp_path / "a.mcap"
    source.write_bytes(content)
    with pytest.raises(RecordingError, match=r"a\.mcap holds no message"):
        export(source, tmp_path / "b.mcap")
    assert not (tmp_path / "b.mcap").exists()


def test_an_export_of_an_export_is_refused(tmp_path):
    export(written(tmp_path / "a.mcap", walk()), tmp_path / "b.mcap")
    with pytest.raises(RecordingError, match="holds no message"):
        export(tmp_path / "b.mcap", tmp_path / "c.mcap")


def test_a_recording_that_is_not_there_leaves_no_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        export(tmp_path / "none.mcap", tmp_path / "b.mcap")
    assert not (tmp_path / "b.mcap").exists()


@pytest.mark.parametrize("name", ["b.mcap", "a.mcap"])
def test_an_existing_file_is_never_written_over(tmp_path, name):
    source = written(tmp_path / "a.mcap", walk())
    target = tmp_path / name
    if target != source:
        target.write_bytes(b"mine")
    before = target.read_bytes()
    with pytest.raises(RecordingError, match="exists already"):
        export(source, target)
    assert target.read_bytes() == before


def test_an_export_that_is_stopped_leaves_no_file(tmp_path):
    def stop(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        export(written(tmp_path / "a.mcap", walk()), tmp_path / "b.mcap", stop)
    assert not (tmp_path / "b.mcap").exists()


@pytest.mark.parametrize("package", ["foxglove", "PIL"])
def test_without_the_extra_one_line_says_what_to_install(tmp_path, monkeypatch, package):
    source = written(tmp_path / "a.mcap", walk())
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, "services.recorder.foxglove.drawings", raising=False)
    with pytest.raises(RecordingError, match=r"pip install 'topnav\[foxglove\]'") as caught:
        export(source, tmp_path / "b.mcap")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "b.mcap").exists()


def test_the_command_line_starts_without_the_sdk():
    modules = "services.launcher.cli, services.launcher.commands.recordings.foxglove"
    source = f"import sys, {modules}; sys.exit('foxglove' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", source], check=False).returncode == 0


def test_a_long_recording_is_never_in_memory_as_a_whole(tmp_path, traced_call):
    rng = np.random.default_rng(1)
    jpeg = [rng.integers(256, size=300_000, dtype=np.uint8).tobytes() for _ in range(4)]
    frames = (("r1/frame", frame(k, encoding="jpeg", data=jpeg[k % 4])) for k in range(100))
    source = written(tmp_path / "a.mcap", frames)
    assert source.stat().st_size > 25_000_000
    _, peak = traced_call(export, source, tmp_path / "b.mcap")
    assert peak < 12_000_000
