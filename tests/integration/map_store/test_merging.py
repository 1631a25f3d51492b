"""The map store asks the feature service over the bus, beside what it answers itself, and can stop then."""

import signal
import threading
from collections.abc import Callable, Iterator

import httpx
import pytest

from shared.bus import Bus, open_bus, wait_until
from shared.messages.matching import MatchReply
from shared.topics import MATCH
from tests.integration.map_store.conftest import START_S, Process
from tests.integration.map_store.test_process import ANSWER_S, ask, transact
from tests.unit.services.map_store.conftest import add

NODES = (0, 1, 2)


@pytest.fixture
def matcher(router_endpoint: str, bus: Bus) -> Iterator[Callable[[], int]]:
    """A feature service that reads the map it is asked about first and never matches; gives the questions."""
    stop, ready, asked = threading.Event(), threading.Event(), []

    def work() -> None:
        with open_bus(router_endpoint) as own:
            questions = own.requests(MATCH, robot="*")
            own.announce("features")
            ready.set()
            while not stop.is_set():
                own.wait(0.02)
                while (question := questions.take()) is not None:
                    wish = question.message
                    read = ask(own, wish.map, action="read")
                    assert read.revision == wish.map_revision
                    asked.append(question)
                    if wish.map != "held":
                        question.reply(MatchReply(map=wish.map, pipeline="sift", max_similarity=150))

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    assert ready.wait(START_S)
    assert wait_until(lambda: bus.alive("features") != [], START_S)
    yield lambda: len(asked)
    stop.set()
    thread.join(START_S)


def started(bus: Bus, process: Process, base: str) -> httpx.Response:
    for name in (base, "other"):
        ask(bus, name, action="create")
        transact(bus, name, *(add(number) for number in NODES))
    url = f"{process.url}/maps/{base}/merge"
    return httpx.post(url, json={"other": "other"}, timeout=ANSWER_S, trust_env=False)


def test_who_is_asked_for_matches_may_read_the_map_meanwhile(
    bus: Bus, process: Process, matcher: Callable[[], int]
):
    answer = started(bus, process, "flat")
    assert (answer.status_code, answer.json()["state"]) == (202, "matching")

    def told() -> dict:
        url = f"{process.url}/maps/flat/merge"
        return httpx.get(url, timeout=ANSWER_S, trust_env=False).json()

    assert wait_until(lambda: told()["state"] != "matching", ANSWER_S)
    assert told() == answer.json() | {
        "state": "refused",
        "matched": len(NODES),
        "reason": "the maps share no place: 0 of 3 look alike, none could be tested",
    }
    assert matcher() == len(NODES)


def test_a_signal_stops_it_while_a_merge_waits_for_an_answer(
    bus: Bus, process: Process, matcher: Callable[[], int]
):
    assert started(bus, process, "held").status_code == 202
    assert wait_until(lambda: matcher() > 0, ANSWER_S)
    assert process.child is not None
    process.child.send_signal(signal.SIGTERM)
    assert process.child.wait(10.0) == 0  # an answer may take twice as long
