"""Doors found by number in two generated offices, from pictures along them; says figures, gates nothing.

chrt -i 0 pytest -q -s tests/benchmarks/test_signs.py

A node every 1.2 m, up to 0.25 m beside the middle and turned any way; the other frame is of 0.1 m before.
A door is found where the bearing of its number, from the best node, is that of its plate to 3 degrees.
"""

import math
import time

import numpy as np
import pytest

from services.signs.keeping import sign_of
from services.signs.reading import signs_in
from services.signs.recognition import TextReader
from services.signs.settings import SignsSettings
from shared.mapgraph.signs import joined
from shared.messages.places import Sign
from simulator.generation.generate import generate
from simulator.generation.splits import split_of
from simulator.settings import CameraSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(1800)]

KIND, SEEDS = "offices", (3, 5)
EVERY_M, ASIDE_M, STEP_M, OFF_RAD = 1.2, 0.25, 0.1, math.radians(3.0)


def poses_of(data, rng):
    """Along the corridor, metres and radians."""
    (corridor,) = (room for room in data["rooms"] if room["name"] == "corridor")
    middle_m = sum(corridor["y_m"]) / 2
    for x in np.arange(0.5, corridor["x_m"][1] - 0.4, EVERY_M):
        yield (
            float(x),
            middle_m + float(rng.uniform(-ASIDE_M, ASIDE_M)),
            float(rng.uniform(-math.pi, math.pi)),
        )


def read_world(seed, read):
    """Signs that are read, where the plates are, the poses of the nodes, and seconds of one core a node."""
    data, signs, spent_s = generate(KIND, seed, "large"), {}, 0.0
    settings = SimulationSettings(camera=CameraSettings(width_px=1024))
    simulation = Simulation(WorldFile.model_validate(data), settings)
    poses = list(poses_of(data, np.random.default_rng(seed)))
    for node, (x, y, yaw) in enumerate(poses):
        frame, beside = simulation.panorama_at(x, y, yaw), simulation.panorama_at(x - STEP_M, y, yaw)
        start_s = time.process_time()
        found = signs_in(frame, beside, read, SignsSettings().least_confidence)
        spent_s += time.process_time() - start_s
        for reading in found:
            signs[reading.text] = joined(signs.get(reading.text), sign_of(node, reading))
    plates = {i["options"]["text"]: i["at_m"] for i in data["furniture"] if i["kind"] == "door_sign"}
    return signs, plates, poses, spent_s / len(poses)


def off_rad(sign: Sign, at_m, poses):
    """By how much the bearing of a sign misses a plate."""
    best = sign.sightings[0]
    x, y, yaw = poses[best.node]
    return abs(math.remainder(math.atan2(at_m[1] - y, at_m[0] - x) - yaw - best.bearing_rad, math.tau))


def test_doors_of_two_offices_are_found_by_number(keep):
    read, found, wrong, others, doors, spent = TextReader(threads=1), 0, 0, [], 0, []
    for seed in SEEDS:
        assert split_of(KIND, seed) == "development"
        signs, plates, poses, spent_s = read_world(seed, read)
        right = {
            text
            for text, at_m in plates.items()
            if text in signs and off_rad(signs[text], at_m, poses) < OFF_RAD
        }
        found, doors = found + len(right), doors + len(plates)
        wrong += sum(text in signs and text not in right for text in plates)
        others += sorted(signs.keys() - plates.keys())
        spent.append(spent_s)
    figures = {"doors": doors, "found": found, "wrong": wrong, "other_texts": others}
    keep({**figures, "core_s_a_node": float(np.mean(spent))})
