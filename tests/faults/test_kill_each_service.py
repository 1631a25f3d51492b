"""kill -9 of each service in turn while the robot drives to a picture, in real time."""

import math
import subprocess
import sys
import threading
import time
from contextlib import suppress

import httpx
import pytest

from services.launcher.processes.wait import LaunchError
from shared.bus import wait_until
from shared.messages.features import ExtractRequest
from shared.messages.missions import Event, MissionRequest
from shared.topics import EVENT, EXTRACT
from tests.e2e.near_node import hiding_place_near_a_node
from tests.faults.watching import MOVES_S, TRIES, Watch, ask

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(1200),
    pytest.mark.usefixtures("patient_sessions"),
]

STOP_S = 0.5
SAMPLE_S = 0.15
"""Truth is sampled at 10 Hz and takes its way: a stop is seen that much later."""

BACK_S = 5.0
START_S = 1.0
"""Chosen: Python with FastAPI, numpy and Zenoh starts sooner beside a stack. Where it takes longer, the
machine is slower just now, and what is started on it is back that much later."""
PATIENCE_S = 90.0
STOPS_THE_WHEELS = ("planner", "drive", "features")
OTHERS = ("map-store", "gateway", "router")


class Killer:
    """Kills a service of a stack while its robot drives, and again where that was not in time.

    Attributes:
        killed_s: when, those of a robot that drove.
        healthy_s: how long it took until the service was healthy again, the shortest of all kills.
    """

    def __init__(self, real_time, service, watch, stop_s):
        self._stack, self._service, self._watch, self._stop_s = real_time.stack, service, watch, stop_s
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._while_it_drives, name="killer")
        self.killed_s, self.healthy_s = [], math.inf

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._thread.join()

    @property
    def stopped_s(self):
        """How long it took until the robot was still, or the service spoke again: the least of all kills."""
        found = [self._watch.still_after_s(at_s) for at_s in self.killed_s]
        found += [self._watch.back_after_s(self._service, at_s) for at_s in self.killed_s]
        return min((after_s for after_s in found if after_s is not None), default=math.inf)

    def kill(self):
        """Kill it now and wait until it is back; returns when that was."""
        at_s = time.monotonic()
        pid = self._stack.launcher.kill(self._service)
        with suppress(LaunchError):
            self._stack.launcher.wait_healthy(self._service, PATIENCE_S, other_than=pid)
            self.healthy_s = min(self.healthy_s, time.monotonic() - at_s)
        return at_s

    def _while_it_drives(self):
        since_s = 0.0
        while len(self.killed_s) < TRIES and (self.healthy_s > BACK_S or self.stopped_s > self._stop_s):
            if not self._drives(since_s):
                return
            self.killed_s.append(self.kill())
            since_s = time.monotonic()

    def _drives(self, since_s):
        wait_until(lambda: self._over.is_set() or self._watch.moving(since_s), MOVES_S)
        return not self._over.is_set() and self._watch.moving(since_s)


def soon_s():
    """How soon a killed service has to be healthy again on a machine as slow as it is now."""
    begun_s = time.monotonic()
    subprocess.run([sys.executable, "-c", "import fastapi, numpy, zenoh"], check=True, timeout=PATIENCE_S)
    return BACK_S * max(1.0, (time.monotonic() - begun_s) / START_S)


def drive_and_kill(real_time, service, stop_s=math.inf):
    """Start a goto and kill `service` while the robot drives; returns the round and its killer."""
    stack, game = real_time.stack, real_time.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(real_time.result, real_time.space, start)
    goal = stack.bus.ask(EXTRACT, ExtractRequest(frame=game.hide(hider)), PATIENCE_S)
    request = MissionRequest(action="goto", map="small", goal=goal, max_steps=1000)
    with Watch(stack.endpoint, stack.robot) as watch, Killer(real_time, service, watch, stop_s) as killer:
        run = game.client.run(request)
    assert killer.killed_s, "the robot never drove"
    played = game.finish(start, hider, game.experimenter.look(hider), run, 0)
    for _ in range(TRIES - len(killer.killed_s)):  # how soon it is back can be seen of a robot at rest, too
        if killer.healthy_s > BACK_S:
            killer.kill()
    return played, killer


@pytest.mark.parametrize("service", STOPS_THE_WHEELS)
def test_the_wheels_stop_the_service_returns_and_the_mission_completes(real_time, service, record_property):
    played, killer = drive_and_kill(real_time, service, STOP_S + SAMPLE_S)
    record_property("stopped_s", killer.stopped_s)
    record_property("healthy_s", killer.healthy_s)
    assert killer.stopped_s <= STOP_S + SAMPLE_S
    assert killer.healthy_s <= soon_s()
    assert played.success, played.run.status.reason


@pytest.mark.parametrize("service", OTHERS)
def test_the_service_returns_and_the_mission_completes(real_time, service, record_property):
    played, killer = drive_and_kill(real_time, service)
    record_property("healthy_s", killer.healthy_s)
    assert killer.healthy_s <= soon_s()
    assert played.success, played.run.status.reason
    assert played.figures()["collisions"] == 0


def test_a_restarted_simulator_is_a_robot_put_elsewhere_and_the_mission_completes(real_time):
    played, killer = drive_and_kill(real_time, "simulator")
    assert killer.healthy_s <= soon_s()
    assert played.run.succeeded, played.run.status.reason
    assert played.distance_m <= 0.5


def test_a_patrol_makes_each_visit_once_whatever_dies_right_after_one(real_time):
    stack, names = real_time.stack, ["start", "middle", "end"]
    nodes = sorted(node.node_id for node in real_time.result.graph.nodes)
    for name, node in zip(names, (nodes[0], nodes[len(nodes) // 2], nodes[-1]), strict=True):
        place = {"name": name, "nodes": [node]}
        httpx.put(
            f"{stack.gateway_url}/api/maps/small/places", json=place, trust_env=False
        ).raise_for_status()
    events, visits = stack.bus.subscribe(EVENT, robot=stack.robot), []

    def made(count):
        found: list[Event] = events.take_all()
        visits.extend(
            value.value for e in found if e.kind == "visited" for value in e.values if value.name == "visit"
        )
        return len(visits) >= count

    real_time.game.begin(seed=1)
    ask(stack, action="patrol", map="small", parameters={"places": names, "rounds": 2}, max_steps=5000)
    for count, service in enumerate(("planner", "map-store", "planner", "features", "drive"), start=1):
        assert wait_until(lambda count=count: made(count), PATIENCE_S), visits
        stack.launcher.kill(service)
    assert wait_until(lambda: made(6), PATIENCE_S), visits
    assert visits == [0, 1, 2, 3, 4, 5]
    assert wait_until(lambda: ask(stack, action="status").state == "succeeded", PATIENCE_S)
    assert ask(stack, action="status").reason == "all 6 visits made"
