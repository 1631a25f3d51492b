"""What tells two rooms furnished alike apart, from a decimetre beside the spot and in another light."""

import math

import cv2
import numpy as np
import pytest

from services.features.matching.difference import differences
from shared.messages.matching import DIFFERENCES_SHAPE
from tests.unit.services.features.matching.blobs import blobs

COLUMNS = 320


@pytest.fixture(scope="module")
def room():
    return blobs(COLUMNS, 8, seed=1)


def difference(current, target, yaw_rad):
    """Root mean square of the ten cells that differ most."""
    cells = differences(current, target, yaw_rad)
    return float(np.sqrt(np.mean(np.sort(cells, axis=None)[-10:] ** 2)))


def jpeg(picture):
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 70])[1].tobytes()


def from_beside(picture, amplitude_px=4.0):
    """What is near shifts, what is far does not: each column by another amount."""
    rows, columns = np.indices(picture.shape[:2], dtype=np.float32)
    shift = amplitude_px * np.sin(columns / COLUMNS * 2.0 * math.pi)
    return cv2.remap(picture, columns + shift, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)


def with_another_rug(picture):
    changed = picture.copy()
    changed[95:125, 150:190] = changed[95:125, 150:190, ::-1]
    return changed


def test_a_step_aside_is_no_difference_but_another_rug_is(room):
    same = difference(jpeg(from_beside(room)), jpeg(room), 0.0)
    other = difference(jpeg(from_beside(room)), jpeg(with_another_rug(room)), 0.0)
    assert other > 2.0 * same


def test_what_only_one_of_two_spots_sees_behind_an_edge_counts_the_same_from_both(room):
    beside = from_beside(room)
    beside[50:110, 200:230] = (200, 60, 220)  # a pillar
    there = difference(jpeg(beside), jpeg(room), 0.0)
    assert there == pytest.approx(difference(jpeg(room), jpeg(beside), 0.0), rel=1e-9)


def test_a_turned_camera_sees_no_difference(room):
    turned_px = 90
    turned = np.roll(room, -turned_px, axis=1)
    yaw_rad = turned_px / COLUMNS * math.tau
    assert difference(jpeg(turned), jpeg(room), yaw_rad) < 0.3 * difference(
        jpeg(turned), jpeg(room), -yaw_rad
    )


def test_what_differs_is_told_where_the_other_picture_has_it(room):
    turned_px = 90
    turned = np.roll(room, -turned_px, axis=1)
    cells = differences(jpeg(turned), jpeg(with_another_rug(room)), turned_px / COLUMNS * math.tau)
    assert cells.shape == DIFFERENCES_SHAPE
    row, column = np.unravel_index(np.argmax(cells), cells.shape)
    assert 95 <= 40 + 5 * (row + 0.5) < 125  # of 160 rows 40 are left out above
    assert 150 <= 5 * (column + 0.5) < 190


def test_what_the_camera_sees_of_its_robot_and_of_who_stands_beside_it_is_little_of_one(room):
    beside = room.copy()
    beside[-24:] = 40
    beside[-32:, 150:190] = 40
    other = difference(jpeg(room), jpeg(with_another_rug(room)), 0.0)
    assert difference(jpeg(beside), jpeg(room), 0.0) < 0.4 * other


def test_another_exposure_is_none_beside_another_rug(room):
    darker = (room * 0.5 + 64.0).astype(np.uint8)
    brighter = np.clip(darker.astype(np.int16) + 20, 0, 255).astype(np.uint8)
    exposed = difference(jpeg(brighter), jpeg(darker), 0.0)
    assert exposed < 0.3 * difference(jpeg(darker), jpeg(with_another_rug(darker)), 0.0)


LARGE = jpeg(np.zeros((1100, 2200, 3), np.uint8))
"""Some kilobytes of one colour that would be decoded to megabytes."""


@pytest.mark.parametrize("thumbnail", [b"", b"no picture", LARGE], ids=["none", "no JPEG", "no thumbnail"])
def test_without_both_pictures_nothing_is_said(room, thumbnail):
    assert differences(jpeg(room), thumbnail, 0.0) is None
    assert differences(thumbnail, jpeg(room), 0.0) is None
