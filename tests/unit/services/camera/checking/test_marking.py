"""The picture for people."""

import math

import numpy as np

from services.camera.checking.marking import FOUND, HORIZON, marked

GREY = np.full((128, 256, 3), 128, np.uint8)


def rows_of(picture, colour, column):
    return np.flatnonzero((picture[:, column] == colour).all(axis=1))


def test_the_horizon_of_the_frames_is_a_line_and_the_four_directions_are_named():
    picture = marked(GREY, None)
    assert picture.shape == (800, 1600, 3)
    assert 400 in rows_of(picture, HORIZON, 200)
    for column in (0, 400, 800, 1200):
        assert len(rows_of(picture, HORIZON, column)) > 600
    assert not (picture == FOUND).all(axis=2).any()


def test_the_horizon_that_was_found_lies_lower_where_the_camera_looks_down():
    up = np.array([math.sin(0.1), 0.0, math.cos(0.1)])
    picture = marked(GREY, up)
    ahead, behind = rows_of(picture, FOUND, 802), rows_of(picture, FOUND, 2)
    assert abs(ahead.mean() - (400 + 0.1 / math.pi * 800)) < 4
    assert abs(behind.mean() - (400 - 0.1 / math.pi * 800)) < 4
