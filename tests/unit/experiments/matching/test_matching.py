"""Placing pictures on the sphere, labels, curves, and what they say of real pictures."""

import numpy as np
import pytest

from experiments.matching.measure import extracted, measure_pair
from experiments.matching.placing import (
    UNCHANGED,
    Change,
    changed_picture,
    placed,
    rectified,
    similarity_of,
    view_of,
)
from experiments.matching.plan import profile_of
from experiments.matching.precision import curve_of
from experiments.matching.study import measured, tangent_wins
from services.features.pipeline.pipeline import Pipeline
from shared.geometry.sphere import EquirectGrid

SIDE = 128
CANVAS = 512


@pytest.fixture(scope="module")
def picture():
    rng = np.random.default_rng(5)
    noise = np.zeros((SIDE, SIDE))
    for step in (4, 8, 16, 32):
        noise += np.kron(rng.normal(size=(SIDE // step, SIDE // step)), np.ones((step, step)))
    return np.clip(128 + 40 * noise, 1, 255).astype(np.uint8)


def test_area_of_a_curve_worked_out_by_hand():
    """Right, right, wrong, right of four correspondences: 1/4 * 1 + 1/4 * 1 + 1/4 * 3/4."""
    curve = curve_of(np.array([1.0, 2.0, 3.0, 4.0]), np.array([True, True, False, True]), 4, thresholds=4)
    np.testing.assert_allclose(curve.recall, [0.25, 0.5, 0.5, 0.75])
    np.testing.assert_allclose(sorted(curve.precision), [2 / 3, 0.75, 1.0, 1.0])
    assert curve.area == pytest.approx(0.25 + 0.25 + 0.25 * 0.75)


def test_no_matches_have_no_area():
    assert curve_of(np.zeros(0), np.zeros(0, bool), 10).area == 0.0


@pytest.mark.parametrize(("lat", "lon"), [(0.0, 0.0), (60.0, 0.0), (-45.0, 90.0), (0.0, 180.0)])
def test_a_placed_picture_is_where_it_says(picture, lat, lon):
    view = view_of(Change("latitude", lat, lat_deg=lat, lon_deg=lon), SIDE)
    canvas = placed(picture, view, CANVAS)
    row, column = np.nonzero(canvas)
    lonlat = EquirectGrid(CANVAS, CANVAS // 2).lonlat_from_pixels(np.stack([column + 0.5, row + 0.5], 1))
    pixels = rectified(lonlat.astype(np.float32), view)
    assert ((pixels > -1.0) & (pixels < SIDE + 1.0)).all()
    inner = ((pixels > 2.0) & (pixels < SIDE - 2.0)).all(axis=1)
    seen = picture[pixels[inner, 1].astype(int), pixels[inner, 0].astype(int)].astype(float)
    there = canvas[row[inner], column[inner]].astype(float)
    assert np.corrcoef(seen, there)[0, 1] > 0.9


@pytest.mark.parametrize("change", [Change("rotation", 90.0), Change("scale", 2.0), Change("rotation", 30.0)])
def test_the_known_map_tells_where_a_pixel_went(picture, change):
    moved, shown = changed_picture(picture, change)
    rng = np.random.default_rng(1)
    at = rng.uniform(50.0, 78.0, (200, 2))
    matrix = similarity_of(change, SIDE)
    there = at @ matrix[:, :2].T + matrix[:, 2]
    keep = ((there > 2) & (there < SIDE - 2)).all(axis=1)
    here, there = at[keep].astype(int), there[keep].astype(int)
    assert shown[there[:, 1], there[:, 0]].all()
    a = picture[here[:, 1], here[:, 0]].astype(float)
    b = moved[there[:, 1], there[:, 0]].astype(float)
    assert np.corrcoef(a, b)[0, 1] > 0.8


def test_the_same_place_matches_wholly_and_a_high_latitude_less(picture):
    pipeline = Pipeline(profile_of("sift", "equirectangular", "brute_force"))
    first = extracted(picture, UNCHANGED, pipeline, CANVAS)
    same = measure_pair(first, first, "euclidean", "brute_force")
    high = measure_pair(
        first,
        extracted(picture, Change("latitude", 60.0, lat_deg=60.0), pipeline, CANVAS),
        "euclidean",
        "brute_force",
    )
    assert same.known.area == pytest.approx(1.0)
    assert high.known.area < 0.9
    assert high.agreement > 0.9


def test_keypoints_of_the_picture_s_edge_are_left_out(picture):
    pipeline = Pipeline(profile_of("orb", "equirectangular", "brute_force"))
    pixels = extracted(picture, Change("rotation", 45.0), pipeline, CANVAS).pixels
    assert len(pixels) > 20
    assert (np.abs(pixels - SIDE / 2.0) < SIDE / 2.0 - 5.0).all()


def test_a_descriptor_without_weights_is_listed_and_not_measured(picture, monkeypatch, tmp_path):
    from experiments.matching.plan import QUICK

    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    monkeypatch.setenv("https_proxy", "http://127.0.0.1:9")
    rows = list(measured("sosnet", [picture], QUICK))
    assert [row["weights"] for row in rows] == ["no weights"] * 4
    assert all(row["map"] is None for row in rows)


def test_tangent_pictures_win_where_their_figure_is_higher():
    row = {"descriptor": "sift", "matcher": "brute_force", "disturbance": "latitude", "level": 60.0}
    rows = [
        row | {"representation": "equirectangular", "map": 0.3},
        row | {"representation": "tangent", "map": 0.6},
    ]
    (verdict,) = tangent_wins(rows)
    assert verdict["tangent_wins"] is True
