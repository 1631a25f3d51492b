"""How many edges, right and wrong ones, are refused as ambiguous; gates nothing.

pytest -q -s tests/benchmarks/test_rival_motions.py
WORLDS=yard-0-small,factory PAIRS=60 pytest -q -s tests/benchmarks/test_rival_motions.py

Streets, yards and shops repeat themselves: fences, shelves, panels. Rendered pairs 1 to 4.5 m apart that see
each other and would be edges by themselves (decision 0015); wrong is a heading more than 10 degrees off.
"""

import math
import os

import numpy as np
import pytest

from experiments.rendered.features import features_seen
from experiments.rendered.pairs import draw_pair
from services.features.matching.verification import Candidate, verify
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.mapping import edges
from services.planner.mapping.rival_motion import is_ambiguous
from services.planner.profiles import DEFAULT
from simulator.world.freespace import free_space
from tests.benchmarks.test_exploring_plans import world_of

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = "street-1-small,street-2-small,street-3-small,yard-0-small,yard-1-small,shop-2-small"
PAIRS, APART_M = 120, (1.0, 4.5)
WRONG_RAD = math.radians(10.0)


@pytest.mark.parametrize("name", os.environ.get("WORLDS", WORLDS).split(","))
def test_how_many_edges_are_refused_as_ambiguous(name, tmp_path, keep, monkeypatch):
    monkeypatch.setattr(edges, "is_ambiguous", lambda _: False)
    world, pipeline, rng = world_of(name, tmp_path), Pipeline(find_profile("sift")), np.random.default_rng(7)
    space, look = free_space(world), features_seen(world, pipeline)
    right, wrong = [], []
    for number in range(int(os.environ.get("PAIRS", PAIRS))):
        pair = draw_pair(space, rng, float(rng.uniform(*APART_M)))
        here, there = look(pair.current), look(pair.target)
        matched = pipeline.matcher.match(here, [there])[0]
        match = verify(here, Candidate(number, there), matched, 0, pipeline.verification, with_matches=True)
        if match.heading_rad is not None and edges.stands_alone(match, DEFAULT):
            off_rad = abs(math.remainder(match.heading_rad - pair.heading_rad, math.tau))
            (wrong if off_rad > WRONG_RAD else right).append(is_ambiguous(match))
    keep({"right": len(right), "refused": sum(right), "wrong": len(wrong), "wrong_refused": sum(wrong)})
