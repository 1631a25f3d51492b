"""The map store over a real bus: questions, deltas, kill -9, restart, clean stop."""

import json
import signal
import threading
import time
import urllib.error
import urllib.request
from typing import Any

import pytest
import zenoh

from shared.bus import Bus, wait_until
from shared.messages.maps import (
    DeleteNode,
    Edge,
    MapDelta,
    MapReply,
    MapRequest,
    MissionRecord,
    MissionRecordRequest,
    PutEdge,
)
from shared.queries import QueryError, RefusedError
from shared.topics import MAP, MAP_DELTA, MISSION_RECORD
from tests.integration.map_store.conftest import START_S, Process
from tests.unit.services.map_store.conftest import add

ANSWER_S = 30.0


def ask(bus: Bus, name: str, **fields) -> MapReply:
    return bus.ask(MAP, MapRequest(**fields), ANSWER_S, map=name)


def transact(bus: Bus, name: str, *operations, **fields) -> int:
    return ask(bus, name, action="transact", operations=operations, **fields).revision


def test_maps_are_written_read_and_followed_over_the_bus(bus: Bus):
    inbox = bus.subscribe(MAP_DELTA, map="flat")
    assert ask(bus, "flat", action="create").revision == 0
    assert transact(bus, "flat", add(0), add(1), PutEdge(edge=Edge(a=0, b=1))) == 1
    assert transact(bus, "flat", DeleteNode(node_id=0), base_revision=1, author="planner") == 2
    deltas: list[MapDelta] = []
    assert wait_until(lambda: len(deltas.extend(inbox.take_all()) or deltas) >= 3, ANSWER_S)
    assert [(delta.revision, delta.reset) for delta in deltas] == [(0, True), (1, False), (2, False)]
    assert deltas[2].author == "planner"
    read = ask(bus, "flat", action="read")
    assert ([node.node_id for node in read.nodes], read.edges, read.revision) == ([1], (), 2)
    assert [entry.node_id for entry in ask(bus, "flat", action="read_features").features] == [1]
    shown = ask(bus, "flat", action="read_pictures").pictures
    assert [(entry.node_id, entry.picture) for entry in shown] == [(1, add(1).features.thumbnail)]


REMOVE = {"action": "transact", "operations": (DeleteNode(node_id=1),)}
LATE = {"action": "transact", "operations": (add(1),), "base_revision": 7}
REFUSED: tuple[tuple[str, dict[str, Any], str, str], ...] = (
    ("house", {"action": "read"}, r"no map 'house'; maps: \['flat'\]", "missing"),
    ("house", REMOVE, "no map 'house'", "missing"),
    ("flat", {"action": "create"}, "map 'flat' exists already", "conflict"),
    ("flat", {"action": "transact"}, "at least one operation", "invalid"),
    ("flat", REMOVE, "node 1 does not exist", "missing"),
    ("flat", LATE, "at revision 0, not 7", "conflict"),
    ("flat", {"action": "read_features", "node_ids": (4,)}, "node 4 does not exist", "missing"),
    ("flat", {"action": "read_pictures", "node_ids": (4,)}, "node 4 does not exist", "missing"),
)


def test_what_cannot_be_done_is_refused_with_the_reason(bus: Bus):
    ask(bus, "flat", action="create")
    for name, fields, told, code in REFUSED:
        with pytest.raises(RefusedError, match=told) as refused:
            ask(bus, name, **fields)
        assert refused.value.code == code


def test_hostile_questions_are_refused_and_the_service_lives(bus: Bus):
    ask(bus, "flat", action="create")
    session: zenoh.Session = bus._session
    for key in (
        "topnav/maps/*/graph",
        "topnav/**",
        "topnav/maps/../graph",
        "topnav/maps/A/graph",
        "topnav/missions/*",
    ):
        for payload in (b"", b"\xc1", b"\x91" * 2_000, b"\xdd\xff\xff\xff\xff"):
            answers = list(session.get(key, payload=payload, timeout=ANSWER_S))
            assert answers
            assert all(answer.err is not None for answer in answers)
    assert ask(bus, "flat", action="read").revision == 0


def test_mission_records_survive_kill_9(bus: Bus, process: Process):
    def claim() -> MissionRecord:
        request = MissionRecordRequest(action="claim", record=MissionRecord(robot="r1"))
        return bus.ask(MISSION_RECORD, request, ANSWER_S, robot="r1")

    first = claim()
    saved = first.model_copy(update={"mission_id": "m-1", "action": "explore", "step": 12})
    bus.ask(MISSION_RECORD, MissionRecordRequest(action="save", record=saved), ANSWER_S, robot="r1")
    restart(bus, process)
    assert claim() == saved.model_copy(update={"epoch": 2})
    with pytest.raises(RefusedError, match="epoch 1 is over, 2 has begun"):
        bus.ask(MISSION_RECORD, MissionRecordRequest(action="save", record=saved), ANSWER_S, robot="r1")
    with pytest.raises(RefusedError, match="record of robot 'r1' sent to the key of 'r2'"):
        bus.ask(MISSION_RECORD, MissionRecordRequest(action="save", record=saved), ANSWER_S, robot="r2")


def restart(bus: Bus, process: Process) -> float:
    """Kill it hard and start it again; seconds until it is alive on the bus."""
    process.kill()
    assert wait_until(lambda: bus.alive("map_store") == [], ANSWER_S)
    started_s = time.monotonic()
    process.start()
    assert wait_until(lambda: bus.alive("map_store") != [], START_S)
    return time.monotonic() - started_s


def test_kill_9_during_a_write_loop_loses_no_acknowledged_write(bus: Bus, process: Process):
    ask(bus, "flat", action="create")
    acknowledged: list[int] = []
    refused: list[str] = []
    stop = threading.Event()

    def write() -> None:
        number = 0
        while not stop.is_set():
            try:
                bus.ask(MAP, MapRequest(action="transact", operations=(add(number),)), 5.0, map="flat")
                acknowledged.append(number)
            except RefusedError as error:
                refused.append(str(error))
            except QueryError:
                continue
            number += 1

    writer = threading.Thread(target=write)
    writer.start()
    try:
        for killed_after in (10, 30, 50):
            assert wait_until(lambda wanted=killed_after: len(acknowledged) >= wanted, START_S)
            restart(bus, process)
    finally:
        stop.set()
        writer.join()
    assert all("exists already" in text for text in refused)  # committed, but killed before the answer
    kept = {node.node_id for node in ask(bus, "flat", action="read").nodes}
    assert kept >= set(acknowledged)
    assert {entry.node_id for entry in ask(bus, "flat", action="read_features").features} == kept


def test_followers_are_told_to_read_again_after_a_restart(bus: Bus, process: Process):
    ask(bus, "flat", action="create")
    transact(bus, "flat", add(0))
    process.kill()
    inbox = bus.subscribe(MAP_DELTA, map="flat")
    process.start()
    deltas: list[MapDelta] = []
    assert wait_until(lambda: any(d.reset for d in deltas.extend(inbox.take_all()) or deltas), START_S)
    assert deltas[-1].revision == 1


def test_rest_and_bus_show_the_same_map(bus: Bus, process: Process):
    ask(bus, "flat", action="create")
    transact(bus, "flat", add(0), add(1))
    inbox = bus.subscribe(MAP_DELTA, map="flat")
    assert call(process, "DELETE", "/maps/flat/nodes/0") == {"map": "flat", "revision": 2}
    assert [node.node_id for node in ask(bus, "flat", action="read").nodes] == [1]
    seen: list[int] = []
    assert wait_until(lambda: 2 in (seen.extend(d.revision for d in inbox.take_all()) or seen), ANSWER_S)
    assert call(process, "GET", "/readyz") == {"status": "ready"}


def call(process: Process, method: str, path: str) -> dict:
    """Ask REST, waiting until it listens."""
    request = urllib.request.Request(process.url + path, method=method)
    answer: list[dict] = []

    def answered() -> bool:
        try:
            with urllib.request.urlopen(request, timeout=ANSWER_S) as response:
                answer.append(json.load(response))
        except urllib.error.HTTPError:
            raise
        except urllib.error.URLError:
            return False
        return True

    assert wait_until(answered, START_S)
    return answer[0]


@pytest.mark.usefixtures("bus")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_stops_it_cleanly(process: Process, number: signal.Signals):
    assert process.child is not None
    process.child.send_signal(number)
    assert process.child.wait(START_S) == 0


def test_a_port_in_use_is_an_error_at_start(bus: Bus, process: Process):
    first = process.child
    process.start()
    second, process.child = process.child, first
    assert second is not None
    assert second.wait(START_S) == 1
    assert ask(bus, "flat", action="create").revision == 0
