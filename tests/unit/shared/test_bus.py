"""Two real peers and a router: delivery policies, questions, liveliness, restarts, junk."""

import contextlib
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
import zenoh

from shared.bus import Bus, open_bus, wait_until
from shared.inbox import Inbox
from shared.messages.drive import Velocity
from shared.messages.maps import MapDelta, MapReply, MapRequest
from shared.messages.missions import Event, MissionStatus
from shared.queries import AbsentError, RefusedError, Requests, TimedOutError
from shared.topics import EVENT, MAP, MAP_DELTA, STATUS, VELOCITY
from shared.transport.router_config import router_config
from shared.wire import WireError

SOON_S = 30.0
PROBE = "probe"

pytestmark = pytest.mark.usefixtures("patient_sessions")


def linked(send: Callable[[], None], inbox: Inbox) -> None:
    """Send until the first sample arrives, then empty the inbox: peers find each other in their own time."""

    def arrived() -> bool:
        send()
        return inbox.take() is not None

    assert wait_until(arrived, SOON_S)


def collected(inbox: Inbox, enough: Callable[[list], bool]) -> list:
    seen: list = []
    assert wait_until(lambda: enough(seen.extend(inbox.take_all()) or seen), SOON_S), seen
    return seen


def test_commands_are_newest_only(here: Bus, there: Bus):
    inbox, publisher = there.subscribe(VELOCITY, robot="*"), here.publisher(VELOCITY, robot="r1")
    linked(lambda: publisher.put(Velocity(robot="r1")), inbox)
    for number in range(1, 51):
        publisher.put(Velocity(robot="r1", seq=number))
    seen: list[int] = []

    def newest_came() -> bool:
        publisher.put(Velocity(robot="r1", seq=50))  # any single command may be dropped under load
        seen.extend(message.seq for message in inbox.take_all())
        return bool(seen) and seen[-1] == 50

    assert wait_until(newest_came, SOON_S), seen
    assert seen == sorted(seen)
    assert len(seen) < 50


def test_events_come_all_and_in_order(here: Bus, there: Bus):
    inbox, publisher = there.subscribe(EVENT, robot="r1"), here.publisher(EVENT, robot="r1")
    linked(lambda: publisher.put(Event(robot="r1", kind="hello")), inbox)
    for number in range(1, 201):
        publisher.put(Event(robot="r1", kind="step", seq=number))
    seen = collected(inbox, lambda messages: bool(messages) and messages[-1].seq == 200)
    assert [event.seq for event in seen if event.seq] == list(range(1, 201))


def test_junk_on_a_topic_is_counted_and_the_next_message_is_read(here: Bus, there: Bus):
    inbox, publisher = there.subscribe(EVENT, robot="r1"), here.publisher(EVENT, robot="r1")
    linked(lambda: publisher.put(Event(robot="r1", kind="hello")), inbox)
    other = b"\x81\xa6schema\xa8frame.v1"
    for junk in (b"", b"\xc1", b"\x91" * 5_000, b"\x80", bytes(200_000), other):
        here._session.put("topnav/r1/event", junk, congestion_control=zenoh.CongestionControl.BLOCK)

    def after_came() -> bool:
        publisher.put(Event(robot="r1", kind="after", seq=1))  # dropped where the junk is still under way
        return any(event.seq == 1 for event in inbox.take_all())

    assert wait_until(after_came, SOON_S)
    assert there.counters.snapshot() == {"malformed": 6}


def test_a_message_too_long_for_its_topic_fails_at_the_sender(here: Bus):
    publisher = here.publisher(STATUS, robot="r1")
    with pytest.raises(WireError, match=r"topnav/\{robot\}/status: at most 1000000 bytes expected"):
        publisher.put(MissionStatus.model_construct(robot="r1", mission_id="x" * 1_000_001))
    publisher.put(MissionStatus(robot="r1"))


def test_putting_on_a_closed_bus_is_an_error_and_closing_twice_is_none(router_endpoint: str):
    with open_bus(router_endpoint) as bus:
        publisher = bus.publisher(VELOCITY, robot="r1")
        bus.close()
        with pytest.raises(zenoh.ZError):
            publisher.put(Velocity(robot="r1"))


def test_publishers_and_subscribers_check_names(here: Bus):
    for name in ("a/b", "R1", "", "r1/**"):
        with pytest.raises(ValueError, match="a robot's name must match"):
            here.publisher(VELOCITY, robot=name)
        with pytest.raises(ValueError, match="a robot's name must match"):
            here.subscribe(VELOCITY, robot=name)


class Asking:
    """A question asked on a thread, so that the test can answer it."""

    def __init__(self, bus: Bus, name: str, timeout_s: float = SOON_S) -> None:
        self.reply: MapReply | None = None
        self.error: Exception | None = None
        self._thread = threading.Thread(target=self._ask, args=(bus, name, timeout_s))
        self._thread.start()

    def _ask(self, bus: Bus, name: str, timeout_s: float) -> None:
        try:
            self.reply = bus.ask(MAP, MapRequest(action="read"), timeout_s, map=name)
        except Exception as error:  # noqa: BLE001  handed to the test's own thread
            self.error = error

    def join(self) -> "Asking":
        self._thread.join()
        return self


def answering(here: Bus, there: Bus) -> Requests:
    """A service on `here` that `there` can already ask."""
    requests = here.requests(MAP, map="*")

    def reachable() -> bool:
        with contextlib.suppress(AbsentError, TimedOutError):
            there.ask(MAP, MapRequest(action="read"), 0.05, map=PROBE)
        return requests.take() is not None

    assert wait_until(reachable, SOON_S)
    while requests.take() is not None:
        pass
    return requests


def taken(requests: Requests):
    found: list = []

    def asked() -> bool:
        question = requests.take()
        if question is not None and question.name != PROBE:  # one of those may come late
            found.append(question)
        return bool(found)

    assert wait_until(asked, SOON_S)
    return found[0]


def test_a_question_is_answered_by_the_service_s_own_loop(here: Bus, there: Bus):
    requests = answering(here, there)
    asking = Asking(there, "flat")
    question = taken(requests)
    assert (question.name, question.message.action) == ("flat", "read")
    question.reply(MapReply(map="flat", revision=3))
    reply = asking.join().reply
    assert reply is not None
    assert reply.revision == 3


def test_a_refusal_carries_the_service_s_words(here: Bus, there: Bus):
    requests = answering(here, there)
    asking = Asking(there, "flat")
    taken(requests).refuse("no map 'flat'", "missing")
    error = asking.join().error
    assert isinstance(error, RefusedError)
    assert (str(error), error.code) == ("no map 'flat'", "missing")


def test_a_refusal_of_an_older_service_has_no_code(here: Bus, there: Bus):
    requests = answering(here, there)
    asking = Asking(there, "flat")
    with taken(requests)._query as query:
        query.reply_err(b"no map 'flat'")
    error = asking.join().error
    assert isinstance(error, RefusedError)
    assert (str(error), error.code) == ("no map 'flat'", "")


def test_nobody_and_nobody_in_time_are_told_apart(here: Bus, there: Bus):
    assert isinstance(Asking(there, "flat", 0.5).join().error, AbsentError)
    answering(here, there)
    assert isinstance(Asking(there, "flat", 0.3).join().error, TimedOutError)


def test_a_late_answer_harms_nobody(here: Bus, there: Bus):
    requests = answering(here, there)
    Asking(there, "flat", 0.2).join()
    taken(requests).reply(MapReply(map="flat", revision=1))
    asking = Asking(there, "flat")
    taken(requests).reply(MapReply(map="flat", revision=2))
    reply = asking.join().reply
    assert reply is not None
    assert reply.revision == 2


@pytest.mark.parametrize(
    "key", ["topnav/maps/*/graph", "topnav/**", "**", "topnav/maps/A b/graph", "topnav/maps/x$*/graph"]
)
def test_questions_to_more_or_less_than_one_name_are_refused_by_the_loop(here: Bus, there: Bus, key: str):
    requests = answering(here, there)
    replies: list = []
    payload = b"\x82\xa6schema\xb0map_request.v1\xa6action\xa4read"
    asker = threading.Thread(
        target=lambda: replies.extend(there._session.get(key, payload=payload, timeout=SOON_S))
    )
    asker.start()
    assert wait_until(lambda: requests.take() is None and not asker.is_alive(), SOON_S)
    assert [b"one name expected" in reply.err.payload.to_bytes() for reply in replies if reply.err] == [True]
    assert here.counters.snapshot() == {"malformed": 1}


def test_malformed_questions_are_refused_and_counted(here: Bus, there: Bus):
    requests = answering(here, there)
    replies: list = []
    ask = lambda: replies.extend(there._session.get("topnav/maps/x/graph", payload=b"\xc1", timeout=SOON_S))  # noqa: E731
    asker = threading.Thread(target=ask)
    asker.start()
    assert wait_until(lambda: requests.take() is None and not asker.is_alive(), SOON_S)
    assert replies[0].err.payload.to_bytes().startswith(b"malformed request: map_request.v1: not msgpack")
    assert here.counters.snapshot() == {"malformed": 1}


CHILD = """
import sys
from shared.bus import open_bus
with open_bus(sys.argv[1]) as bus:
    bus.announce("child")
    print("ready", flush=True)
    sys.stdin.read()
"""


def test_a_process_killed_hard_is_gone_from_the_bus(here: Bus, router_endpoint: str, repository: Path):
    changes: list[tuple[str, bool]] = []
    here.watch_alive(lambda service, _instance, alive: changes.append((service, alive)), "child")
    command = [sys.executable, "-c", CHILD, router_endpoint]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, cwd=repository, env=os.environ, **pipes) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == b"ready\n"
        assert wait_until(lambda: ("child", True) in changes and here.alive("child") == ["child"], SOON_S)
        child.kill()
        assert wait_until(lambda: changes[-1] == ("child", False), SOON_S)
        assert wait_until(lambda: here.alive("child") == [], SOON_S)


def delta(revision: int) -> MapDelta:
    return MapDelta(map="flat", revision=revision)


def test_a_late_follower_gets_the_deltas_it_missed(here: Bus, there: Bus):
    publisher, early = here.publisher(MAP_DELTA, map="flat"), there.subscribe(MAP_DELTA, map="flat")
    for revision in range(1, 21):
        publisher.put(delta(revision))
    collected(early, lambda messages: bool(messages) and messages[-1].revision == 20)  # none is under way
    seen = collected(there.subscribe(MAP_DELTA, map="flat"), lambda messages: len(messages) >= 20)
    assert [message.revision for message in seen] == list(range(1, 21))


def test_who_has_unsubscribed_hears_nothing_more(here: Bus, there: Bus):
    publisher = here.publisher(MAP_DELTA, map="flat")
    left, stays = (there.subscribe(MAP_DELTA, map="flat") for _ in range(2))
    publisher.put(delta(1))
    collected(left, bool)
    there.unsubscribe(left)
    publisher.put(delta(2))
    collected(stays, lambda seen: [each.revision for each in seen] == [1, 2])
    assert left.take_all() == []


def test_deltas_sent_while_the_router_was_away_are_recovered_in_order(free_port: Callable[[], int]):
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = zenoh.open(router_config(endpoint))
    with open_bus(endpoint) as sender, open_bus(endpoint) as follower:
        inbox, publisher = follower.subscribe(MAP_DELTA, map="flat"), sender.publisher(MAP_DELTA, map="flat")
        publisher.put(delta(1))
        seen = collected(inbox, lambda messages: len(messages) >= 1)
        router.close()
        for revision in range(2, 12):
            publisher.put(delta(revision))
        router = zenoh.open(router_config(endpoint))
        seen += collected(inbox, lambda messages: len(messages) >= 10)
    router.close()
    assert [message.revision for message in seen] == list(range(1, 12))
