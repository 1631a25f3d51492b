"""The router dies, or the network is cut and heals: nothing stale moves the robot, no delta is lost."""

import os
import subprocess
import sys
import time
from contextlib import contextmanager
from itertools import count

import pytest
import zenoh

from shared.bus import Bus, open_bus, wait_until
from shared.messages.drive import Velocity
from shared.messages.maps import MapRequest
from shared.topics import MAP, MAP_DELTA, VELOCITY
from shared.transport.session_config import peer_config
from shared.wire import decode
from tests.faults.lived_maps import place
from tests.faults.proxy import Proxy
from tests.integration.drive.conftest import Neighbours
from tests.integration.map_store.conftest import Process

pytestmark = [pytest.mark.timeout(300)]

LEFT, RIGHT = 0.5, -0.5
LEASE_S = 2.0
GAP_S, TURN_S, LONG_TURN_S = 1.0, 0.05, 0.1
START_S, RECOVERY_S, ANSWER_S = 60.0, 60.0, 30.0
TRIES = 3
"""Drive, or the proxy in this process, may be held up just when a cut heals or a router dies: the best of so
many counts. What is broken is so every time."""


@contextmanager
def behind_a_proxy(port, away):
    """A bus session that others reach through a proxy only, and the proxy."""
    config = peer_config(away, f"tcp/127.0.0.1:{port}")
    config.insert_json5("scouting/gossip/enabled", "false")  # or they would meet behind the proxy's back
    bus = Bus(zenoh.open(config))
    try:
        with Proxy(port) as proxy:
            yield bus, proxy
    finally:
        bus.close()


@pytest.fixture
def cut(free_port, tmp_path):
    """A drive process that reaches robot and planner through a proxy only."""
    with behind_a_proxy(free_port(), f"tcp/127.0.0.1:{free_port()}") as (bus, proxy):
        state = {"TOPNAV_ENDPOINT": proxy.endpoint, "DRIVE_STATE_DIR": str(tmp_path)}
        process = subprocess.Popen([sys.executable, "-m", "services.drive"], env=os.environ | state)
        try:
            assert wait_until(lambda: bus.alive("drive") == ["drive"], START_S)
            yield proxy, Neighbours(bus)
        finally:
            process.kill()
            process.wait()


@pytest.mark.parametrize("cut_s", [0.75 * LEASE_S, 2.0 * LEASE_S], ids=["within the lease", "beyond it"])
def test_what_was_said_while_the_network_was_cut_moves_nothing_when_it_heals(cut, cut_s, record_property):
    proxy, neighbours = cut
    frames = count(1)

    def say(heading_rad):
        def act():
            seq = next(frames)
            neighbours.see(seq)
            neighbours.wish(seq, heading_rad=heading_rad)

        return act

    heard = []  # all of them: in the burst a newer one may come before anybody has looked
    neighbours.bus.tap(VELOCITY, lambda _, sent: heard.append(decode(Velocity, sent, VELOCITY.max_bytes)))

    def stale_over_a_cut():
        assert neighbours.drives(say(LEFT))
        proxy.cut()
        del heard[:]
        neighbours.commands(cut_s, say(RIGHT))
        proxy.heal()
        healed_s = time.monotonic()
        assert neighbours.drives(say(LEFT))
        record_property("driving_again_s", round(time.monotonic() - healed_s, 3))
        neighbours.commands(0.5, say(LEFT))
        return [command for command in heard if command.speed_mps and command.left_mps < 0.0]

    for _ in range(TRIES):
        stale = stale_over_a_cut()
        if not stale:
            break
    assert stale == []


class Router:
    """A router process that may be killed and started again at the same place."""

    def __init__(self, port: int) -> None:
        self.endpoint = f"tcp/127.0.0.1:{port}"
        self.start()

    def start(self) -> None:
        environment = os.environ | {"TOPNAV_ROUTER_LISTEN": self.endpoint}
        self.process = subprocess.Popen([sys.executable, "-m", "shared.router"], env=environment)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


@pytest.fixture
def router(free_port):
    router = Router(free_port())
    yield router
    router.kill()


@pytest.fixture
def processes(router, repository, tmp_path, free_port):
    """Drive and map store at that router."""
    state = {"TOPNAV_ENDPOINT": router.endpoint, "DRIVE_STATE_DIR": str(tmp_path)}
    drive = subprocess.Popen([sys.executable, "-m", "services.drive"], env=os.environ | state)
    store = Process(repository, tmp_path, router.endpoint, free_port())
    store.start()
    yield
    store.kill()
    drive.kill()
    drive.wait()


def revisions(deltas, newest):
    """Those of all deltas up to `newest`, in the order they came."""
    found: list[int] = []

    def complete():
        found.extend(delta.revision for delta in deltas.take_all())
        return found[-1:] == [newest]

    wait_until(complete, RECOVERY_S)
    return found


def write(bus, number):
    """Add one place to map m; the revision."""
    request = MapRequest(action="transact", operations=(place(number),))
    return bus.ask(MAP, request, ANSWER_S, map="m").revision


class Talk:
    """A robot whose frames drive answers, and a map that grows meanwhile.

    Attributes:
        written: newest revision of the map.
        longest_s: the longest time spent waiting for a command in vain. What this process, or the map store,
            takes longer for is no silence of drive's: no turn counts for more than LONG_TURN_S.
    """

    def __init__(self, bus):
        self._bus, self._neighbours, self._frames = bus, Neighbours(bus), count(1)
        self.written, self.longest_s, self._silent_s = 0, 0.0, 0.0

    def turn(self):
        seq, began_s = next(self._frames), time.monotonic()
        self._neighbours.see(seq)
        self._neighbours.wish(seq)
        answered = bool(self._neighbours.commands(TURN_S))
        self._silent_s = 0.0 if answered else self._silent_s + min(time.monotonic() - began_s, LONG_TURN_S)
        self.longest_s = max(self.longest_s, self._silent_s)
        return answered

    def go_on(self, during_s):
        until_s = time.monotonic() + during_s
        while time.monotonic() < until_s:
            self.turn()
            self.written = write(self._bus, self.written)


@pytest.mark.usefixtures("processes")
def test_while_the_router_is_away_commands_go_on_and_no_delta_is_lost(router, record_property):
    with open_bus(router.endpoint) as bus, open_bus(router.endpoint) as follower:
        assert wait_until(lambda: {"drive", "map_store"} <= set(bus.alive()), START_S)
        deltas, talk = follower.subscribe(MAP_DELTA, map="m"), Talk(bus)
        bus.ask(MAP, MapRequest(action="create"), ANSWER_S, map="m")
        assert wait_until(talk.turn, START_S)
        for _ in range(TRIES):
            talk.longest_s = 0.0
            for phase_s, act in ((0.5, lambda: None), (3.0, router.kill), (3.0, router.start)):
                act()
                talk.go_on(phase_s)
            if talk.longest_s < GAP_S:
                break
        record_property("longest_gap_s", round(talk.longest_s, 3))
        record_property("deltas", talk.written)
        assert talk.longest_s < GAP_S
        assert revisions(deltas, talk.written) == list(range(talk.written + 1))
        with open_bus(router.endpoint) as newcomer:
            assert wait_until(lambda: newcomer.alive("map_store") == ["map_store"], START_S)
            assert newcomer.ask(MAP, MapRequest(action="read"), ANSWER_S, map="m").revision == talk.written


def test_deltas_of_a_cut_beyond_the_lease_are_fetched_when_it_heals(repository, tmp_path, free_port):
    direct = f"tcp/127.0.0.1:{free_port()}"
    with behind_a_proxy(free_port(), f"tcp/127.0.0.1:{free_port()}") as (follower, proxy):
        store = Process(repository, tmp_path, proxy.endpoint, free_port(), listen=direct)
        deltas = follower.subscribe(MAP_DELTA, map="m")
        store.start()
        try:
            with open_bus(direct) as writer:
                for bus in (follower, writer):
                    assert wait_until(lambda bus=bus: bus.alive("map_store") == ["map_store"], START_S)
                writer.ask(MAP, MapRequest(action="create"), ANSWER_S, map="m")
                write(writer, 0)
                assert revisions(deltas, 1) == [0, 1]
                proxy.cut()
                for number in range(1, 6):
                    write(writer, number)
                    time.sleep(LEASE_S / 4)
                time.sleep(LEASE_S)
                assert deltas.take_all() == []
                proxy.heal()
                assert revisions(deltas, 6) == [2, 3, 4, 5, 6]
        finally:
            store.kill()
