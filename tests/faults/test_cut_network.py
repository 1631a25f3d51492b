"""The router dies, or the network is cut and heals: nothing stale moves the robot, no delta is lost."""

import os
import subprocess
import sys
import time
from contextlib import contextmanager
from itertools import count, pairwise

import pytest
import zenoh

from shared.bus import Bus, open_bus, wait_until
from shared.bus_config import peer_config
from shared.messages import MapRequest
from shared.topics import MAP, MAP_DELTA
from tests.faults.lived_maps import place
from tests.faults.proxy import Proxy
from tests.integration.drive.conftest import START_S, Neighbours
from tests.integration.map_store.conftest import Process

LEFT, RIGHT = 0.5, -0.5
LEASE_S = 2.0
GAP_S = 1.0
RECOVERY_S = 15.0


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

    assert neighbours.drives(say(LEFT))
    proxy.cut()
    heard_while_cut = neighbours.commands(cut_s, say(RIGHT))
    proxy.heal()
    healed_s = time.monotonic()
    after = []

    def drives_again():
        after.extend(neighbours.commands(0.1, say(LEFT)))
        return any(command.wheel_speed_radps for command in after[-3:])

    assert wait_until(drives_again, RECOVERY_S)
    record_property("driving_again_s", round(time.monotonic() - healed_s, 3))
    after += neighbours.commands(0.5, say(LEFT))
    stale = [c for c in (*heard_while_cut, *after) if c.wheel_speed_radps and c.steer_rad < 0.0]
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


def longest_gap_s(times_s):
    return max((b - a for a, b in pairwise(times_s)), default=float("inf"))


def revisions(deltas, newest):
    """Those of all deltas up to `newest`, in the order they came."""
    found: list[int] = []
    wait_until(lambda: (found.extend(d.revision for d in deltas.take_all()), found[-1:])[1] == [newest], 15.0)
    return found


def write(bus, number):
    """Add one place to map m; the revision."""
    request = MapRequest(action="transact", operations=(place(number),))
    return bus.ask(MAP, request, 10.0, map="m").revision


@pytest.mark.usefixtures("processes")
def test_while_the_router_is_away_commands_go_on_and_no_delta_is_lost(router, record_property):
    with open_bus(router.endpoint) as bus, open_bus(router.endpoint) as follower:
        assert wait_until(lambda: {"drive", "map_store"} <= set(bus.alive()), START_S)
        deltas = follower.subscribe(MAP_DELTA, map="m")
        neighbours, frames = Neighbours(bus), count(1)
        bus.ask(MAP, MapRequest(action="create"), 10.0, map="m")
        times_s: list[float] = []
        written = 0

        def turn():
            seq = next(frames)
            neighbours.see(seq)
            neighbours.wish(seq)
            times_s.extend([time.monotonic()] if neighbours.commands(0.05) else [])

        assert wait_until(lambda: (turn(), times_s)[1], 10.0)
        del times_s[:]
        for phase_s, act in ((0.5, lambda: None), (3.0, router.kill), (3.0, router.start)):
            act()
            until_s = time.monotonic() + phase_s
            while time.monotonic() < until_s:
                turn()
                written = write(bus, written)
        record_property("longest_gap_s", round(longest_gap_s(times_s), 3))
        record_property("deltas", written)
        assert longest_gap_s(times_s) < GAP_S
        assert revisions(deltas, written) == list(range(written + 1))
        with open_bus(router.endpoint) as newcomer:
            assert newcomer.ask(MAP, MapRequest(action="read"), 10.0, map="m").revision == written


def test_deltas_of_a_cut_beyond_the_lease_are_fetched_when_it_heals(repository, tmp_path, free_port):
    direct = f"tcp/127.0.0.1:{free_port()}"
    with behind_a_proxy(free_port(), f"tcp/127.0.0.1:{free_port()}") as (follower, proxy):
        store = Process(repository, tmp_path, proxy.endpoint, free_port(), listen=direct)
        deltas = follower.subscribe(MAP_DELTA, map="m")
        store.start()
        try:
            with open_bus(direct) as writer:
                assert wait_until(lambda: follower.alive("map_store") == ["map_store"], START_S)
                writer.ask(MAP, MapRequest(action="create"), 10.0, map="m")
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
