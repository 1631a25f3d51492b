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
from shared.messages.features import Features
from shared.messages.matching import MatchReply
from shared.messages.missions import MissionRequest
from shared.messages.sensors import Ranges
from shared.topics import FEATURES, HEADING, MATCH, MISSION, RANGES, TRUTH
from tests.integration.map_store.conftest import Process
from tests.integration.simulator.conftest import room_data as room_data
from tests.integration.simulator.conftest import room_file as room_file

pytestmark = [pytest.mark.timeout(600), pytest.mark.usefixtures("patient_sessions")]

START_S, SOON_S = 120.0, 30.0
FRAME_S = 0.3
"""An exploration that recognises nothing gives up after some 120: none is shown while processes start."""
ENOUGH = 5
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
            self.answer(FRAME_S)
            epochs += [heading.epoch for heading in self._headings.take_all()]
        return epochs

    def answer(self, during_s):
        """Show nothing for a while, but answer what is asked about the last frame."""
        until_s = time.monotonic() + during_s
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
        command = [sys.executable, "-m", "tests.patient", module]
        processes.append((subprocess.Popen(command, env=environment, stderr=log), log))
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
    store = Process(repository, tmp_path, router_endpoint, free_port(), patient=True)
    store.start()
    try:
        with open_bus(router_endpoint) as bus:
            eyes = Eyes(bus)
            first = run("services.planner")
            assert wait_until(lambda: bus.alive("planner") == ["planner"], START_S)
            status = bus.ask(MISSION, MissionRequest(action="explore", map="m"), SOON_S, robot="r1")
            assert wait_until(lambda: status.epoch in eyes.look(FRAME_S), SOON_S)
            run("services.planner")

            def both_are_there():
                eyes.answer(FRAME_S)
                return len(bus.alive("planner")) == 2

            def heard_of_it():
                eyes.look(FRAME_S)
                return "another planner drives this robot" in run.told(first)

            def spoken():
                epochs.extend(eyes.look(FRAME_S))
                return len(epochs) >= ENOUGH

            assert wait_until(both_are_there, START_S)
            assert wait_until(lambda: status.epoch + 1 in eyes.look(FRAME_S), SOON_S)
            assert wait_until(heard_of_it, SOON_S)
            eyes.look(FRAME_S)  # what it said before may be under way
            epochs = []
            assert wait_until(spoken, SOON_S)
            assert set(epochs) == {status.epoch + 1}
            for _ in range(5):
                now = bus.ask(MISSION, MissionRequest(action="status"), SOON_S, robot="r1")
                assert (now.epoch, now.mission_id) == (status.epoch + 1, status.mission_id)
            assert first.poll() is None
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
        assert wait_until(lambda: "alarm: another process calls itself robot 'r1'" in run.told(first), SOON_S)
        truths.take_all()
        before = truths.wait(SOON_S)
        assert before is not None
        assert wait_until(lambda: any(t.sim_time_s > before.sim_time_s for t in truths.take_all()), SOON_S)
        assert wait_until(lambda: bus.alive("simulator") == ["simulator"], SOON_S)
        first.kill()
        first.wait()
        assert wait_until(lambda: bus.alive("simulator") == [], SOON_S)
        robot("three")
        assert wait_until(lambda: bus.alive("simulator") == ["simulator"], START_S), "the name is free again"
