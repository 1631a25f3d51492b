"""Two peers whose link is cut while both keep the one to the router, which had told them of each other."""

import contextlib
import os
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import zenoh

from shared.bus import Bus, open_bus, wait_until
from shared.transport import reconnection
from shared.transport.reconnection import PeerReconnection, refused
from shared.transport.session_config import peer_config

SOON_S = 30.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


@contextlib.contextmanager
def peer(router_endpoint: str, name: str) -> Iterator[Bus]:
    with open_bus(router_endpoint) as bus:
        bus.announce(name)
        yield bus


def hear_each_other(here: Bus, there: Bus) -> bool:
    return here.alive() == there.alive() == ["here", "there"]


def cut_link(here: Bus, there: Bus) -> None:
    """Break the TCP connection between two peers of this process."""
    ports = {
        int(link.src.rpartition(":")[2])
        for link in here._session.info.links()
        if str(link.zid) == str(there._session.info.zid())
    }
    assert ports
    for number in Path("/proc/self/fd").iterdir():
        with contextlib.suppress(OSError), socket.socket(fileno=os.dup(int(number.name))) as end:
            if end.family == socket.AF_INET and end.getpeername()[1] in ports:
                end.shutdown(socket.SHUT_RDWR)


def test_two_that_lost_each_other_and_not_the_router_meet_again(router_endpoint: str):
    lost: list[str] = []
    with peer(router_endpoint, "here") as here, peer(router_endpoint, "there") as there:
        here.watch_alive(lambda name, _, alive: None if alive else lost.append(name))
        assert wait_until(lambda: hear_each_other(here, there), SOON_S)
        assert not lost
        cut_link(here, there)
        assert wait_until(lambda: "there" in lost, SOON_S)
        assert wait_until(lambda: hear_each_other(here, there), SOON_S)


def test_a_peer_that_ended_is_not_looked_for_long(router_endpoint: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reconnection, "FIRST_PAUSE_S", 3.0)  # on a busy machine a loss is seen late
    with (
        zenoh.open(peer_config(router_endpoint)) as session,
        PeerReconnection(session, router_endpoint) as peers,
    ):
        for _ in range(4):  # of two peers the one with the greater id dials: about half of these were dialled
            with zenoh.open(peer_config(router_endpoint)) as other:
                assert wait_until(lambda: other.info.zid() in session.info.peers_zid(), SOON_S)
            assert wait_until(lambda: peers.lost, SOON_S)
        # A look too early, or when somebody else was given the port, is followed by another.
        assert wait_until(lambda: not peers.lost, SOON_S)


def test_who_ended_or_was_not_dialled_is_told_from_who_stands_still(free_port: Callable[[], int]):
    assert refused(f"tcp/127.0.0.1:{free_port()}")
    assert refused("tcp/nonsense")
    with socket.create_server(("127.0.0.1", 0), backlog=1) as server, contextlib.ExitStack() as ends:
        listening = f"tcp/127.0.0.1:{server.getsockname()[1]}"
        assert not refused(listening)
        dialled = ends.enter_context(socket.create_connection(server.getsockname()))
        assert refused(f"tcp/127.0.0.1:{dialled.getsockname()[1]}")
        with contextlib.suppress(TimeoutError):  # until its queue is full, as that of a process that hangs
            while True:
                ends.enter_context(socket.create_connection(server.getsockname(), 0.2))
        assert not refused(listening)
