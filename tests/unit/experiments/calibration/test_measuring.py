"""What calibration makes of a rendered pair: S as the rules count it, and only answers that are used."""

from dataclasses import replace

import pytest

from experiments.calibration import proposal
from experiments.calibration.measuring import of_rendering
from experiments.calibration.thresholds import Pair
from experiments.rendered.headings import PairResult
from services.features.pipeline.named_pipelines import PROFILES
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.environments import Spans
from services.launcher.client.failure import ExperimentError
from services.planner.profiles import DEFAULT, THESIS

RESULT = PairResult(
    distance_m=1.2,
    raw=70,
    verified=40,
    status="ok",
    confidence=0.9,
    disparity_rad=0.1,
    yaw_error_rad=0.0,
    verified_errors_rad={"epipolar": 0.02},
    raw_errors_rad={"epipolar": 0.02},
)


@pytest.mark.parametrize(("rules", "similarity"), [(DEFAULT, 40), (THESIS, 70)])
def test_similarity_is_what_the_rules_count(rules, similarity):
    assert of_rendering(RESULT, rules) == Pair(similarity, 0.02, 1.2)


def test_an_answer_too_unsure_for_an_edge_is_none():
    assert of_rendering(replace(RESULT, confidence=0.4), DEFAULT) == Pair(40, None, 1.2)


def asked(rules):
    return proposal.Asked(Pipeline(PROFILES["thesis"]), rules, Spans(), 20, 1, lambda _: None)


@pytest.mark.parametrize(
    ("rules", "names"),
    [
        (DEFAULT, {"s_via_min", "s_edge_min", "s_node_max", "s_via_max", "edge_longest_m"}),
        (THESIS, {"s_via_min", "s_edge_min", "s_node_max", "s_via_max", "s_final", "s_slow", "s_max"}),
    ],
)
def test_a_world_gives_what_the_rules_count(monkeypatch, tmp_path, rules, names):
    near = [replace(RESULT, distance_m=distance_m) for distance_m in (0.4, 0.6, 0.8, 1.2)]
    monkeypatch.setattr(proposal, "measure", lambda *_: near)
    found = proposal.of_world(asked(rules), "apartment", tmp_path)
    assert set(found.thresholds) == names
    assert rules.replaced(**found.thresholds).travel.s_max == (150 if rules is THESIS else 300)


@pytest.mark.parametrize("source", [proposal.of_tours, proposal.of_recording])
def test_rules_that_stop_by_count_are_calibrated_in_a_world(tmp_path, source):
    with pytest.raises(ExperimentError, match="thesis ends a path by the count"):
        source(asked(THESIS), tmp_path)
