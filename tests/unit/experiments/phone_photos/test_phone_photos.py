"""Phone pictures: cut where they look, told as EXIF tells them, judged by place and direction."""

import math

import numpy as np
import pytest

from experiments.phone_photos.judging import error_of, judge, summary
from experiments.phone_photos.taking import Shot, in_whole_millimetres, shots_at, taken
from shared.mapgraph.photographs.search import PhotoPlace
from shared.mapgraph.photographs.verdict import PhotoAnswer
from shared.messages.simulation import Pose

NODES = {7: Pose(x_m=2.0, y_m=1.0, yaw_rad=math.pi / 2)}


def shot(**changes):
    choices = {"pitch_rad": 0.0, "roll_rad": 0.0, "fov_rad": 1.2, "fov_known": True, "portrait": False}
    return Shot(Pose(x_m=2.0, y_m=1.5, yaw_rad=math.pi), **(choices | changes))


def place(x_m=0.5, y_m=0.0, yaw_rad=math.pi / 2):
    return PhotoPlace(7, x_m, y_m, 0.0, yaw_rad, 1.2, 80.0, 20)


def test_half_of_the_pictures_tell_their_field_of_view_and_all_are_drawn_by_seed():
    poses = [Pose(x_m=float(k), y_m=0.0, yaw_rad=0.0) for k in range(10)]
    drawn = shots_at(poses, np.random.default_rng(4))
    assert sum(one.fov_known for one in drawn) == 5
    assert drawn == shots_at(poses, np.random.default_rng(4))
    assert all(math.radians(50) <= one.fov_rad <= math.radians(110) for one in drawn)


def test_the_middle_of_a_level_picture_is_what_the_panorama_shows_ahead_and_a_pitch_shows_what_is_above():
    panorama = np.zeros((512, 1024, 3), np.uint8)
    panorama[246:266, 502:522] = 255
    panorama[160:180, 502:522, 0] = 255  # 30 degrees up, blue

    def middle(one):
        photo = taken(one, lambda _: panorama, 1.3)
        pixels = np.frombuffer(photo.data, np.uint8).reshape(photo.height_px, photo.width_px, 3)
        return pixels[photo.height_px // 2, photo.width_px // 2].tolist()

    assert min(middle(shot())) > 200
    blue, _, red = middle(shot(pitch_rad=math.radians(30.0)))
    assert blue > 200 > 50 > red


def test_exif_tells_whole_millimetres_and_a_silent_picture_what_is_usual():
    assert abs(in_whole_millimetres(1.2) - 1.2) < 0.02
    silent = taken(shot(fov_known=False, portrait=True), lambda _: np.zeros((64, 128, 3), np.uint8), 1.3)
    assert (silent.view.fov_rad, silent.view.fov_known, silent.view.aspect) == (1.3, False, 0.75)


def test_a_place_is_judged_in_the_world_by_its_node():
    assert error_of(place(), shot().pose, NODES) == (pytest.approx(0.0), pytest.approx(0.0))
    off_m, off_rad = error_of(place(x_m=0.5, y_m=1.2, yaw_rad=math.pi / 2 + 0.3), shot().pose, NODES)
    assert (off_m, off_rad) == (pytest.approx(1.2), pytest.approx(0.3))


def test_only_a_place_named_alone_is_right_or_wrong():
    far = place(y_m=1.2)
    answers = [
        PhotoAnswer("found", (place(),)),
        PhotoAnswer("found", (far,)),
        PhotoAnswer("ambiguous", (far, place())),
        PhotoAnswer("weak", (far,)),
        PhotoAnswer("not_found", ()),
    ]
    rows = [judge(shot(), answer, NODES) for answer in answers]
    told = summary(rows)
    assert [told[name] for name in ("photos", "right", "wrong", "ambiguous", "weak", "not_found")] == [
        5,
        1,
        1,
        1,
        1,
        1,
    ]
    assert told["ambiguous_with_the_place"] == 1
