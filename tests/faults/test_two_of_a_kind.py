"""Two planners or two robots of one name: one of them it is, the other stands by or ends, and says so."""

import os
import subprocess
import sys
import time
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from shared.bus import open_bus, wait_until
from shared.messages import Features, MatchReply, MissionRequest, Ranges
from shared.topics import FEATURES, HEADING, MATCH, MISSION, RANGES, TRUTH
from tests.integration.map_store.conftest import Process
from tests.integration.simulator.conftest import room_data as room_data
from tests.integration.simulator.conftest import room_file as room_file

START_S = 60.0
FRAME_S = 0.3
"""An exploration that recognises nothing gives up after some 120 frames."""
NUMBERS = np.zeros((1, 2), np.float32), np.zeros(1, np.float32), np.zeros((1, 4), np.uint8)


class Eyes:
    """Stands in for robot and feature service: every frame looks like nothing known."""

    def __init__(self, bus):
        self._bus, self._frames = bus, count(1)
        self._features, self._ranges = bus.publisher(FEATURES, robot="r1"), bus.publisher(RANGES, robot="r1")
        self._matches = bus.requests(MATCH, robot="r1")
        self._headings = bus.subscribe(HEADING, robot="r1")

    def look(self, during_s):
        """Show frames for a while; the epochs of the headings that come, in order."""
        until_s, epochs = time.monotonic() + during_s, []
        while time.monotonic() < until_s:
            now = {"seq": next(self._frames), "stamp_ns": time.time_ns(), "robot": "r1"}
            lonlat, scores, descriptors = NUMBERS
            angles = tuple(k * 0.5 for k in range(12))
            self._ranges.put(Ranges(**now, angles_rad=angles, distances_m=(4.0,) * 12, max_range_m=4.0))
            self._features.put(
                Features(**now, pipeline="x", lonlat_rad=lonlat, scores=scores, descriptors=descriptors)
            )
            self._answer(time.monotonic() + FRAME_S)
            epochs += [heading.epoch for heading in self._headings.take_all()]
        return epochs

    def _answer(self, until_s):
        while (left_s := until_s - time.monotonic()) > 0.0:
            self._bus.wait(left_s)
            while (question := self._matches.take()) is not None:
                asked = question.message
                question.reply(MatchReply(seq=asked.seq, map=asked.map, pipeline="x", max_similarity=150))


@pytest.fixture
def run(router_endpoint, tmp_path):
    """Start `python -m MODULE` with some variables; all end with the test."""
    processes = []

    def launch(module, **variables):
        environment = os.environ | {"TOPNAV_ENDPOINT": router_endpoint} | variables
        log = (tmp_path / f"{module}-{len(processes)}.log").open("w+b")
        processes.append((subprocess.Popen([sys.executable, "-m", module], env=environment, stderr=log), log))
        return processes[-1][0]

    def told(process):
        """What a process wrote to its log."""
        return Path(next(log.name for each, log in processes if each is process)).read_text(encoding="utf-8")

    launch.told = told
    yield launch
    for process, log in processes:
        process.kill()
        process.wait()
        log.close()


def test_of_two_planners_the_later_decides_alone_and_the_other_stands_by(
    run, router_endpoint, repository, tmp_path, free_port
):
    store = Process(repository, tmp_path, router_endpoint, free_port())
    store.start()
    try:
        with open_bus(router_endpoint) as bus:
            eyes = Eyes(bus)
            first = run("services.planner")
            assert wait_until(lambda: bus.alive("planner") == ["planner"], START_S)
            status = bus.ask(MISSION, MissionRequest(action="explore", map="m"), 10.0, robot="r1")
            assert wait_until(lambda: status.epoch in eyes.look(0.3), 20.0)
            run("services.planner")
            assert wait_until(lambda: status.epoch + 1 in eyes.look(0.3), START_S)
            eyes.look(1.5)  # the first hears of it by the other's heartbeat
            epochs = eyes.look(2.0)
            assert epochs
            assert set(epochs) == {status.epoch + 1}
            for _ in range(5):
                now = bus.ask(MISSION, MissionRequest(action="status"), 10.0, robot="r1")
                assert (now.epoch, now.mission_id) == (status.epoch + 1, status.mission_id)
            assert first.poll() is None
            assert "another planner drives this robot" in run.told(first)
    finally:
        store.kill()


@pytest.mark.render
def test_a_second_robot_of_the_same_name_ends_with_an_alarm_and_the_first_drives_on(
    run, router_endpoint, room_file, tmp_path
):
    def robot(folder):
        return run(
            "simulator",
            SIMULATOR_WORLD=room_file,
            SIMULATOR_WIDTH_PX="256",
            SIMULATOR_CACHE_DIR=str(tmp_path / "cache"),
            SIMULATOR_STATE_DIR=str(tmp_path / folder),
        )

    with open_bus(router_endpoint) as bus:
        truths = bus.subscribe(TRUTH, robot="r1")
        first = robot("one")
        assert wait_until(lambda: bus.alive("simulator") == ["simulator"], START_S)
        second = robot("two")
        assert second.wait(START_S) == 1
        assert "driven by another process already" in run.told(second)
        assert "alarm: another process calls itself robot 'r1'" in run.told(first)
        truths.take_all()
        before = truths.wait(5.0)
        assert wait_until(lambda: (t := truths.take()) is not None and t.sim_time_s > before.sim_time_s, 10.0)
        assert bus.alive("simulator") == ["simulator"]
        first.kill()
        first.wait()
        robot("three")
        assert wait_until(lambda: bus.alive("simulator") == ["simulator"], START_S), "the name is free again"
