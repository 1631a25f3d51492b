"""Files of `topnav camera calibrate`: what is no such file is named in one line."""

import json

import pytest

from services.camera.mount.calibration_file import (
    CalibrationFileError,
    load_calibration,
    write_calibration,
)
from tests.fisheye_camera import FRONT_BACK


def test_what_was_written_is_read_again(tmp_path):
    file = tmp_path / "new" / "camera.json"
    write_calibration(file, FRONT_BACK)
    assert load_calibration(file) == FRONT_BACK


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"format": "other"}, "format: Input should be 'topnav-fisheye-1'"),
        ({"lenses": []}, "lenses"),
        ({"width_px": 10**9}, "width_px"),
        ({"surprise": 1}, "surprise"),
    ],
)
def test_a_file_that_says_something_else_is_named_with_its_field(tmp_path, change, said):
    file = tmp_path / "camera.json"
    file.write_text(json.dumps(FRONT_BACK.model_dump(mode="json") | change), encoding="utf-8")
    with pytest.raises(CalibrationFileError, match=said) as told:
        load_calibration(file)
    assert "\n" not in str(told.value)


def test_a_rotation_that_mirrors_is_refused(tmp_path):
    document = FRONT_BACK.model_dump(mode="json")
    document["lenses"][0]["rotation"] = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]
    file = tmp_path / "camera.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(CalibrationFileError, match=r"lenses\.0\.rotation"):
        load_calibration(file)


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xd8", b"[" * 50_000, b" " * 200_000])
def test_what_is_no_file_of_ours_is_refused(tmp_path, data):
    file = tmp_path / "camera.json"
    file.write_bytes(data)
    with pytest.raises(CalibrationFileError, match=r"camera\.json"):
        load_calibration(file)


def test_a_file_that_is_not_there_says_what_writes_it(tmp_path):
    with pytest.raises(CalibrationFileError, match="'topnav camera calibrate' writes such a file"):
        load_calibration(tmp_path / "none.json")


def test_a_larger_picture_of_the_same_camera_has_the_same_lenses():
    twice = FRONT_BACK.scaled(2 * FRONT_BACK.width_px)
    assert twice.height_px == 2 * FRONT_BACK.height_px
    assert twice.lenses[1].focal_px == 2 * FRONT_BACK.lenses[1].focal_px
    assert twice.lenses[1].centre_px[0] == 2 * FRONT_BACK.lenses[1].centre_px[0]
