"""What calibration makes of a rendered pair: S as the rules count it, and only answers that are used."""

from dataclasses import replace

import pytest

from experiments.calibration.measuring import of_rendering
from experiments.calibration.thresholds import Pair
from experiments.rendered.headings import PairResult
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
