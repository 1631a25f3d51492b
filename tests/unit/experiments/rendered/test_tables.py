"""Statistics of the heading study from hand-made results."""

import math

import pytest

from experiments.rendered.headings import METHODS, PairResult
from experiments.rendered.tables import confidence_table, distance_table, method_table, status_counts


def result(distance_m, error_deg, verified=30):
    error = None if error_deg is None else math.radians(error_deg)
    errors = dict.fromkeys(METHODS, error)
    status = "ok" if error is not None else "too_few"
    return PairResult(distance_m, 60, verified, status, 0.9, 0.1, 0.0, errors, errors)


def test_unanswered_pairs_are_counted_apart():
    table = method_table([result(1, 1.0), result(1, 3.0), result(1, None)])
    assert table["4"]["median_deg"] == pytest.approx(2.0)
    assert table["4"]["answered"] == 2
    assert status_counts([result(1, 1.0), result(1, None)]) == {"ok": 1, "too_few": 1}


def test_bins_share_no_pair_and_the_last_one_holds_its_end():
    rows = distance_table([result(0.5, 1.0, 90), result(0.4, 1.0, 80), result(12.0, 1.0, 10)])
    assert [(row["distance_m"], row["pairs"], row["verified"]) for row in rows] == [
        ("0.3-0.5", 1, 80),
        ("0.5-1", 1, 90),
        ("8-12", 1, 10),
    ]


def test_confidence_is_compared_with_how_often_a_bearing_is_right():
    pairs = [result(1, 1.0), result(1, 3.0), result(1, 40.0), result(1, None)]
    (only,) = confidence_table(pairs)["bins"]
    assert only == {"confidence": 0.9, "right": pytest.approx(2 / 3, abs=1e-3), "n": 3}
