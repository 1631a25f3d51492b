"""Figures of answers made by hand."""

import pytest

from experiments.photographs.comparing import Answer
from experiments.photographs.tables import LinkAnswer, calibration, row, tilt_row


def answer(heading_deg=None, confidence=0.9, *, edge=False, status="ok"):
    return Answer(0, 1, status, 50, 30, confidence, heading_deg, "epipolar", edge, 1.0)


def link(bearing_deg, *args, **fields):
    return LinkAnswer(bearing_deg, answer(*args, **fields))


def test_a_line_of_the_table():
    links = [
        link(170.0, -175.0, edge=True),  # 15 off, across the seam
        link(0.0, 20.0),  # neither within 20 nor beyond 90
        link(0.0, 90.5),
        link(5.0),
    ]
    assert row("flat", 3, links, 2, [True, False]) == {
        "name": "flat",
        "pictures": 3,
        "links": 4,
        "answered": 0.75,
        "within_20": pytest.approx(1 / 3, abs=1e-4),
        "beyond_90": pytest.approx(1 / 3, abs=1e-4),
        "median_deg": 20.0,
        "p90_deg": pytest.approx(76.4),
        "edges": 0.25,
        "wrong_edges": 2,
        "recall_at_1": 0.5,
    }


def test_nothing_answered_has_no_errors():
    figures = row("flat", 2, [link(0.0)], 0, [])
    assert figures["answered"] == 0.0
    assert figures["within_20"] is figures["median_deg"] is figures["recall_at_1"] is None


def test_ece_weighs_bins_by_their_answers():
    right, wrong = link(0.0, 0.0, 0.95), link(0.0, 100.0, 0.95)
    low = link(0.0, 0.0, 0.25)
    found = calibration([right, right, wrong, low, link(0.0)])
    assert found["bins"] == [
        {"confidence": 0.25, "right": 1.0, "n": 1},
        {"confidence": 0.95, "right": pytest.approx(2 / 3, abs=1e-4), "n": 3},
    ]
    assert found["ece"] == pytest.approx(0.25 * 0.75 + 0.75 * (0.95 - 2 / 3), abs=1e-4)


def test_full_confidence_falls_into_the_last_bin_and_no_answers_into_none():
    (last,) = calibration([link(0.0, 0.0, 1.0), link(0.0, 0.0, 0.92)])["bins"]
    assert last == {"confidence": pytest.approx(0.96), "right": 1.0, "n": 2}
    assert calibration([link(0.0)]) == {"ece": None, "bins": []}


def test_a_tilted_picture_counts_as_moved_by_geometry_alone():
    same = [
        answer(10.0, edge=True),
        answer(10.0),
        answer(edge=True, status="no_baseline"),
        answer(status="inconsistent"),
    ]
    assert tilt_row(2.0, same, [1.0, 3.0, 50.0]) == {
        "deg": 2.0,
        "same_moved": 0.5,
        "same_edges": 0.25,
        "median_change_deg": 3.0,
    }
    assert tilt_row(2.0, same, [])["median_change_deg"] is None
