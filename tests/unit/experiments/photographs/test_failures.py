"""Failures worst first, and a picture of one."""

from types import SimpleNamespace

import numpy as np
import pytest

from experiments.photographs.comparing import Answer
from experiments.photographs.failures import failures_of
from experiments.photographs.pair_picture import (
    ANSWERED,
    INLIER,
    TRUE,
    WIDTH_PX,
    Caption,
    pair_picture,
)
from experiments.photographs.study import Found
from experiments.photographs.tables import LinkAnswer
from shared.messages.matching import NodeMatch


def answer(number, heading_deg=None, inliers=10, raw=50):
    return Answer(number, number + 1, "ok", raw, inliers, 0.9, heading_deg, "epipolar", False, 1.0)


def test_wrong_edges_come_first_then_headings_by_error_then_what_might_have_been_answered():
    links = [
        LinkAnswer(0.0, answer(1, 25.0)),
        LinkAnswer(0.0, answer(2, 19.0)),
        LinkAnswer(0.0, answer(3, -170.0)),
        LinkAnswer(0.0, answer(4, raw=5)),
        LinkAnswer(0.0, answer(5, raw=90)),
    ]
    tour = SimpleNamespace(links=links, wrong=[answer(6, inliers=31)])
    found = Found([tour], [], [], [answer(7, inliers=40)], [], [])
    told = [(one.kind, one.answer.query) for one in failures_of(found)]
    assert told == [
        ("wrong edge", 7),
        ("wrong edge", 6),
        ("wrong heading", 3),
        ("wrong heading", 1),
        ("unanswered", 5),
        ("unanswered", 4),
    ]


def columns_of(picture, colour):
    return np.flatnonzero((picture == colour).all(axis=2).any(axis=0))


@pytest.fixture
def drawn():
    """Draw a pair with one inlier, 90 degrees to the left in the frame and to the right in the candidate."""
    match = NodeMatch(
        node_id=1,
        raw_matches=1,
        inliers=1,
        status="ok",
        matches_rad=np.array([[np.pi / 2, 0.0, -np.pi / 2, 0.0]], np.float32),
        inlier_mask=np.ones(1, np.uint8),
    )
    pictures = np.zeros((64, 128, 3), np.uint8), np.zeros((32, 64, 3), np.uint8)

    def draw(answered_deg, true_deg):
        whole = pair_picture(pictures, match, answered_deg, true_deg, Caption("title", "figures", "two-view"))
        return whole[80:]  # below the legend, which has the colours of the arrows too

    return draw


def test_arrows_and_matches_stand_where_the_bearings_are(drawn):
    picture = drawn(45.0, -135.0)
    assert np.median(columns_of(picture, ANSWERED)) == pytest.approx(WIDTH_PX * 3 / 8, abs=2)
    assert np.median(columns_of(picture, TRUE)) == pytest.approx(WIDTH_PX * 7 / 8, abs=2)
    inlier = columns_of(picture, INLIER)
    assert inlier.min() == pytest.approx(WIDTH_PX / 4, abs=4)
    assert inlier.max() == pytest.approx(WIDTH_PX * 3 / 4, abs=4)


def test_what_is_unknown_has_no_arrow(drawn):
    picture = drawn(None, None)
    assert not len(columns_of(picture, ANSWERED))
    assert not len(columns_of(picture, TRUE))
