"""What the live view keeps while it waits, converts only for who looks, and makes of a map's changes."""

import threading

import pytest

from services.recorder.backlog import Sample
from services.recorder.foxglove.drawings import draw
from services.recorder.foxglove.live import newest as newest_module
from services.recorder.foxglove.live.converting import Converter
from services.recorder.foxglove.live.followed_map import FollowedMap
from services.recorder.foxglove.live.newest import Newest
from services.recorder.foxglove.live.settings import LiveSettings
from shared.inbox import Counters
from shared.messages.maps import Edge, MapDelta, MapReply, Node, PutEdge
from shared.messages.missions import Event
from shared.messages.sensors import Ranges
from shared.topics import EVENT, FRAME
from shared.wire import encode

KEY = "topnav/r1/ranges"
EVEN = tuple(k * 0.5235987755982988 for k in range(12))


def ranges(seq=0, angles_rad=EVEN):
    return Ranges(robot="r1", seq=seq, angles_rad=angles_rad, distances_m=(1.0,) * 12, max_range_m=4.0)


def sample(message, key=KEY):
    return Sample(key, message if isinstance(message, bytes) else encode(message), 1)


def newest(counters=None, **limits):
    return Newest(threading.Event(), counters or Counters(), **limits)


def test_of_frames_the_newest_waits_and_of_decisions_all():
    counters = Counters()
    waiting = newest(counters)
    for seq in range(3):
        waiting.push(FRAME, "topnav/r1/frame", b"%d" % seq)
        waiting.push(EVENT, "topnav/r1/event", b"%d" % seq)
    taken = [(one.key, one.payload) for one in waiting.take_all()]
    assert [payload for key, payload in taken if key == "topnav/r1/frame"] == [b"2"]
    assert [payload for key, payload in taken if key == "topnav/r1/event"] == [b"0", b"1", b"2"]
    assert counters.snapshot() == {}, "nothing that somebody would want is lost"
    assert waiting.take_all() == []


def test_of_decisions_that_are_too_many_the_oldest_make_room_and_are_counted(monkeypatch):
    monkeypatch.setitem(newest_module.CAPACITY, EVENT.delivery, 2)
    counters = Counters()
    waiting = newest(counters)
    for seq in range(3):
        waiting.push(EVENT, "topnav/r1/event", b"%d" % seq)
    assert [one.payload for one in waiting.take_all()] == [b"1", b"2"]
    assert counters.snapshot() == {"overflow": 1}


def test_what_waits_is_bounded_in_bytes_and_what_was_taken_makes_room():
    counters = Counters()
    waiting = newest(counters, max_bytes=10)
    for _ in range(3):
        waiting.push(EVENT, "topnav/r1/event", b"12345")
    assert len(waiting.take_all()) == 2
    assert counters.snapshot() == {"overflow": 1}
    for _ in range(2):
        waiting.push(EVENT, "topnav/r1/event", b"12345")
    assert len(waiting.take_all()) == 2


def test_a_frame_that_makes_room_gives_its_bytes_back():
    waiting = newest(max_bytes=10)
    for payload in (b"first.", b"second", b"third."):
        waiting.push(FRAME, "topnav/r1/frame", payload)
    assert [one.payload for one in waiting.take_all()] == [b"third."]


def test_a_peer_that_invents_robots_takes_no_more_than_so_many_keys(monkeypatch):
    monkeypatch.setattr(newest_module, "MAX_KEYS", 2)
    waiting = newest()
    for robot in "abc":
        waiting.push(FRAME, f"topnav/{robot}/frame", b"1")
    assert [one.key for one in waiting.take_all()] == ["topnav/a/frame", "topnav/b/frame"]


class Shown:
    """Remembers what was shown; `looking` at nothing at first."""

    def __init__(self):
        self.looking, self.put_in = set(), []

    def watched(self, name):
        return name in self.looking

    def put(self, form, stamp_ns):
        assert stamp_ns == 1
        self.put_in.append(form.channel)


@pytest.fixture
def shown():
    return Shown()


@pytest.fixture
def counters():
    return Counters()


@pytest.fixture
def converter(shown, counters):
    return Converter(shown, [draw], counters)


def test_the_first_message_makes_the_channels_and_others_are_converted_for_who_looks(shown, converter):
    for seq in range(3):
        converter.show(sample(ranges(seq)))
    assert shown.put_in == [KEY, f"{KEY}/scan"]
    shown.looking.add(f"{KEY}/scan")
    converter.show(sample(ranges(4)))
    assert shown.put_in == [KEY, f"{KEY}/scan"] * 2


def test_who_begins_to_look_sees_the_last_message_but_no_decision_twice(shown, converter):
    decision = Event(robot="r1", kind="heading", reason="to node 3")
    converter.show(sample(ranges()))
    converter.show(sample(decision, "topnav/r1/event"))
    shown.put_in.clear()
    converter.show_again({f"{KEY}/scan", "topnav/r1/event", "topnav/r1/event/log"})
    assert shown.put_in == [KEY, f"{KEY}/scan"]


def test_what_cannot_be_read_or_drawn_is_counted(shown, converter, counters):
    converter.show(sample(b"no msgpack"))
    assert counters.snapshot() == {"malformed": 1}
    uneven = (*EVEN[:-1], EVEN[-1] + 0.1)
    converter.show(sample(ranges(angles_rad=uneven)))
    assert counters.snapshot() == {"malformed": 1, "undrawable": 1}
    assert shown.put_in == [KEY], "its numbers are there"


@pytest.fixture
def followed():
    one = FollowedMap()
    one.load(MapReply(map="flat", revision=4, nodes=(Node(node_id=0), Node(node_id=1))))
    one.changed = False
    return one


def delta(revision, **more):
    return MapDelta(map="flat", revision=revision, operations=(PutEdge(edge=Edge(a=0, b=1)),), **more)


def test_a_map_follows_the_next_change_and_passes_over_what_it_has(followed):
    followed.apply(delta(4))
    assert (followed.revision, followed.changed, len(followed.graph.edges)) == (4, False, 0)
    followed.apply(delta(5))
    assert (followed.revision, followed.changed, len(followed.graph.edges)) == (5, True, 1)
    assert not followed.stale


@pytest.mark.parametrize("missed", [delta(6), delta(2, reset=True)], ids=["gap", "undone"])
def test_after_a_gap_a_map_is_to_be_read_anew(followed, missed):
    followed.apply(missed)
    assert followed.stale
    followed.apply(delta(5))
    assert followed.revision == 4, "nothing is built on what may be wrong"


def test_a_change_that_does_not_fit_means_that_too(followed):
    wrong = PutEdge(edge=Edge(a=0, b=7))
    followed.apply(MapDelta(map="flat", revision=5, operations=(wrong,)))
    assert followed.stale


def test_the_true_pose_is_left_out_and_a_misspelt_topic_refused(monkeypatch):
    assert LiveSettings.from_environment().without == "truth"
    assert LiveSettings.from_environment().host == "127.0.0.1"
    monkeypatch.setenv("FOXGLOVE_LIVE_WITHOUT", "frames")
    with pytest.raises(ValueError, match="a topic must be one of"):
        LiveSettings.from_environment()
