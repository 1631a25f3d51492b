"""kill -9 of each service in turn while the robot drives to a picture, in real time."""

import math
import threading
import time
from contextlib import suppress

import pytest

from services.launcher.supervisor import LaunchError
from shared.bus import wait_until
from shared.messages import ExtractRequest, MissionRequest
from shared.topics import EXTRACT
from tests.e2e.near_node import hiding_place_near_a_node
from tests.faults.watching import Watch

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

STOP_S = 0.5
SAMPLE_S = 0.15
"""Truth is sampled at 10 Hz and takes its way: a stop is seen that much later."""

BACK_S = 5.0
PATIENCE_S = 30.0
STOPS_THE_WHEELS = ("planner", "drive", "features")
OTHERS = ("map-store", "gateway", "router")


def drive_and_kill(real_time, service):
    """Start a goto and kill `service` once the robot drives; returns the round, the watch and the times."""
    stack, game = real_time.stack, real_time.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(real_time.result, real_time.space, start)
    goal = stack.bus.ask(EXTRACT, ExtractRequest(frame=game.hide(hider)), 30.0)
    killed = {"at_s": math.inf, "healthy_after_s": math.inf}

    def kill_once_it_drives():
        if not wait_until(watch.moving, timeout_s=30.0):
            return
        killed["at_s"] = time.monotonic()
        pid = stack.launcher.kill(service)
        with suppress(LaunchError):
            stack.launcher.wait_healthy(service, PATIENCE_S, other_than=pid)
            killed["healthy_after_s"] = time.monotonic() - killed["at_s"]

    with Watch(stack.endpoint, stack.robot) as watch:
        killer = threading.Thread(target=kill_once_it_drives)
        killer.start()
        request = MissionRequest(action="goto", map="small", goal=goal, max_steps=1000)
        run = game.client.run(request)
        killer.join()
    return game.finish(start, hider, game.hand.look(hider), run, 0), watch, killed


@pytest.mark.parametrize("service", STOPS_THE_WHEELS)
def test_the_wheels_stop_the_service_returns_and_the_mission_completes(real_time, service, record_property):
    played, watch, killed = drive_and_kill(real_time, service)
    still_s = watch.still_after_s(killed["at_s"])
    back_s = watch.back_after_s(service, killed["at_s"])
    for name, value in (("still_s", still_s), ("back_s", back_s), ("healthy_s", killed["healthy_after_s"])):
        record_property(name, value)
    assert still_s is not None
    assert min(still_s, back_s or still_s) <= STOP_S + SAMPLE_S, f"still {still_s}, back {back_s}"
    assert killed["healthy_after_s"] <= BACK_S
    assert played.success, played.run.status.reason


@pytest.mark.parametrize("service", OTHERS)
def test_the_service_returns_and_the_mission_completes(real_time, service, record_property):
    played, _, killed = drive_and_kill(real_time, service)
    record_property("healthy_s", killed["healthy_after_s"])
    assert killed["healthy_after_s"] <= BACK_S
    assert played.success, played.run.status.reason
    assert played.figures()["collisions"] == 0


def test_a_restarted_simulator_is_a_robot_put_elsewhere_and_the_mission_completes(real_time):
    played, _, killed = drive_and_kill(real_time, "simulator")
    assert killed["healthy_after_s"] <= BACK_S
    assert played.run.succeeded, played.run.status.reason
    assert played.distance_m <= 0.5
