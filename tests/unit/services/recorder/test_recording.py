"""What was recorded is read back byte by byte; what was cut off is saved up to the damage."""

import contextlib
import threading

import pytest

from services.recorder.backlog import Backlog, Sample
from services.recorder.channels import RecordingError, topic_of, topics_named
from services.recorder.reading import WholePart, contents, read
from services.recorder.recording import RecordingWriter, recover
from shared.messages.sensors import Ranges
from shared.topics import TOPICS
from shared.wire import encode


def samples(count, size=0):
    return [
        Sample(
            "topnav/r1/ranges" if k % 2 else "topnav/r2/frame",
            encode(
                Ranges(robot="r1", seq=k, angles_rad=(0.0,) * 12, distances_m=(1.0,) * 12, max_range_m=4.0)
            )
            + bytes(size),
            1_000_000_000 + k * 100_000_000,
        )
        for k in range(count)
    ]


def written(path, count=50, size=0):
    with RecordingWriter(path) as writer:
        for k, sample in enumerate(samples(count, size)):
            writer.write(sample)
            if k % 10 == 9:
                writer.flush()
    return path


def test_a_recording_is_read_back_as_it_was(tmp_path):
    path = written(tmp_path / "a.mcap")
    assert list(read(path)) == samples(50)
    index = contents(path)
    assert index.counts == {"topnav/r1/ranges": 25, "topnav/r2/frame": 25}
    assert index.duration_s == pytest.approx(4.9)


def test_keys_of_others_are_left_out(tmp_path):
    path = tmp_path / "a.mcap"
    with RecordingWriter(path) as writer:
        writer.write(Sample("weather/berlin", b"rain", 1))
        writer.write(samples(2)[1])
    assert [sample.key for sample in read(path)] == ["topnav/r1/ranges"]


def test_an_existing_file_is_never_written_over(tmp_path):
    path = written(tmp_path / "a.mcap")
    before = path.read_bytes()
    with pytest.raises(RecordingError, match="exists already"):
        RecordingWriter(path)
    assert path.read_bytes() == before


@pytest.mark.parametrize("share", [0.3, 0.6, 0.95])
def test_a_recording_that_was_cut_off_is_saved_up_to_the_cut(tmp_path, share):
    whole = written(tmp_path / "a.mcap", 200, 500).read_bytes()
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(RecordingError, match="topnav recover"):
        list(read(broken))
    found = recover(broken, tmp_path / "saved.mcap")
    assert not found.whole
    saved = list(read(tmp_path / "saved.mcap"))
    assert saved == samples(200, 500)[: len(saved)]
    assert len(saved) == found.messages >= 10


def test_a_whole_recording_is_recovered_whole(tmp_path):
    found = recover(written(tmp_path / "a.mcap"), tmp_path / "b.mcap")
    assert (found.messages, found.whole) == (50, True)
    assert list(read(tmp_path / "b.mcap")) == samples(50)


@pytest.mark.parametrize("content", [b"", b"no recording at all", bytes(1000)])
def test_what_is_no_recording_is_refused_and_leaves_no_file(tmp_path, content):
    path = tmp_path / "a.mcap"
    path.write_bytes(content)
    with pytest.raises(RecordingError):
        recover(path, tmp_path / "b.mcap")
    assert not (tmp_path / "b.mcap").exists()
    with pytest.raises(RecordingError):
        list(read(path))
    with pytest.raises(RecordingError):
        contents(path)


@pytest.mark.parametrize("place", range(40))
def test_damage_anywhere_is_told_as_such(tmp_path, place):
    data = bytearray(written(tmp_path / "a.mcap").read_bytes())
    at = place * len(data) // 40
    data[at : at + 8] = b"\xff" * 8
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(data)
    for reading in (lambda: list(read(broken)), lambda: contents(broken)):
        with contextlib.suppress(RecordingError):
            reading()
    with broken.open("rb") as stream:
        whole = WholePart(stream)
        assert len(list(whole)) <= 50


def test_a_recording_that_is_not_there_is_no_damaged_one(tmp_path):
    with pytest.raises(FileNotFoundError):
        contents(tmp_path / "none.mcap")


def test_every_topic_is_found_by_its_key():
    for topic in TOPICS:
        given = {"robot": "r1", "map": "flat"}
        names = {name: value for name, value in given.items() if f"{{{name}}}" in topic.template}
        assert topic_of(topic.key(**names)) == (topic, names)
    assert topic_of("topnav/r1/unknown") is None
    assert topic_of("topnav/R1/frame") is None


def test_a_misspelt_topic_is_named():
    assert topics_named(" frame, truth ") == {"frame", "truth"}
    with pytest.raises(RecordingError, match="got frames"):
        topics_named("frames")


def test_a_disk_that_is_too_slow_costs_the_newest_and_is_counted():
    backlog = Backlog(threading.Event(), max_bytes=10)
    for _ in range(4):
        backlog.push("topnav/r1/frame", b"1234")
    assert len(backlog.take_all()) == 2
    assert backlog.dropped() == {"topnav/r1/frame": 2}
    backlog.push("topnav/r1/frame", b"1234")
    assert len(backlog.take_all()) == 1
