"""The answer to a write is lost with the connection or the map store: asked again, it is not done again."""

import sqlite3
import threading
import time
from contextlib import closing, suppress

import pytest

from shared.bus import Bus, wait_until
from shared.messages.maps import Edge, MapReply, MapRequest, PutEdge
from shared.queries import AbsentError
from shared.topics import MAP
from tests.faults.lived_maps import place
from tests.faults.test_cut_network import behind_a_proxy
from tests.integration.map_store.conftest import Process

START_S, ANSWER_S = 60.0, 30.0


@pytest.fixture
def store_behind_proxy(repository, tmp_path, free_port):
    """An asker, the proxy between, the map store, and its file."""
    with behind_a_proxy(free_port(), f"tcp/127.0.0.1:{free_port()}") as (bus, proxy):
        store = Process(repository, tmp_path, proxy.endpoint, free_port())
        store.start()
        try:
            assert wait_until(lambda: bus.alive("map_store") == ["map_store"], START_S)
            yield bus, proxy, store, tmp_path / "maps.sqlite3"
        finally:
            store.kill()


class Write:
    """A bare edge, driven once more, asked for on a thread until there is an answer or `join` ends."""

    def __init__(self, bus: Bus) -> None:
        self.answer: MapReply | None = None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._ask, args=(bus,))
        self._thread.start()

    def _ask(self, bus: Bus) -> None:
        edge = PutEdge(edge=Edge(a=0, b=1, traversals=1))
        request = MapRequest(action="transact", operations=(edge,))
        while self.answer is None and not self._over.is_set():
            with suppress(AbsentError):  # a map store takes longer to start than asking again goes on
                self.answer = bus.ask(MAP, request, ANSWER_S, map="m")

    def join(self) -> int:
        self._thread.join(2 * ANSWER_S)
        self._over.set()
        assert self.answer is not None
        return self.answer.revision


def revision(file):
    with closing(sqlite3.connect(file)) as connection:
        return connection.execute("SELECT revision FROM maps").fetchone()[0]


@pytest.mark.parametrize("killed", [False, True], ids=["connection", "map store"])
def test_a_write_whose_answer_is_lost_is_done_once(store_behind_proxy, killed):
    bus, proxy, store, file = store_behind_proxy
    bus.ask(MAP, MapRequest(action="create"), ANSWER_S, map="m")
    bus.ask(MAP, MapRequest(action="transact", operations=(place(0), place(1))), ANSWER_S, map="m")
    proxy.lose()
    write = Write(bus)
    assert wait_until(lambda: revision(file) == 2, ANSWER_S), "the write did not reach the map store"
    time.sleep(0.1)  # the answer is on its way by now, and lost
    if killed:
        store.kill()
        store.start()
    proxy.hang_up()
    assert write.join() == 2
    assert bus.ask(MAP, MapRequest(action="read"), ANSWER_S, map="m").revision == 2
