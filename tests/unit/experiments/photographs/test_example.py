"""The rendered tour: its bearings are true."""

import json
import math

import numpy as np
import pytest

from experiments.photographs.example import bearing_deg, render_example, room_of
from experiments.photographs.looks import picture_of
from experiments.photographs.tilting import tilt
from experiments.photographs.tours import read_tour
from services.launcher.client.failure import ExperimentError
from simulator.world.world_file import load_world


def test_bearings_are_counter_clockwise_from_where_the_camera_looks():
    assert bearing_deg((1.0, 1.0, 0.0), (1.0, 3.0, 0.0)) == pytest.approx(90.0)
    assert bearing_deg((1.0, 1.0, math.pi / 2), (2.0, 1.0, 0.0)) == pytest.approx(-90.0)
    rolled = bearing_deg((0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, math.radians(60.0)))
    assert rolled == pytest.approx(math.degrees(math.atan2(0.5, 1.0)))


def test_rooms_are_those_of_the_world():
    world = load_world("apartment")
    assert room_of(world, (3.0, 3.0, 0.0)) == "living"
    assert room_of(world, (1.5, -0.1, 0.0)) is None  # in the door


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "holiday.jpg").write_bytes(b"")
    with pytest.raises(ExperimentError, match="expected an empty folder or an earlier tour"):
        render_example(load_world("apartment"), tmp_path, 2, 1)


@pytest.mark.render
def test_the_tour_is_one_that_can_be_read(example):
    tour = read_tour(example / "tour.json")
    assert len(tour.paths) == 4
    assert set(tour.neighbours()) == {0, 1, 2, 3}
    assert {(b, a) for a, b, _ in tour.links()} == {(a, b) for a, b, _ in tour.links()}
    assert json.loads((example / "tour.json").read_text())["rooms"]


@pytest.mark.render
def test_remapped_pictures_are_those_of_a_tilted_camera(tmp_path, monkeypatch):
    taken = {}
    for name, tilt_deg in (("upright", 0.0), ("tilted", 8.0)):
        monkeypatch.setattr("experiments.photographs.example.TILT_DEG", (tilt_deg, tilt_deg))
        monkeypatch.setattr("experiments.photographs.example.pitch_roll", lambda angle, _: (angle, angle / 2))
        render_example(load_world("apartment"), tmp_path / name, 2, 1)
        taken[name] = picture_of(tmp_path / name / "00.jpg")
    remapped = tilt(taken["upright"], math.radians(8.0), math.radians(4.0))
    differs = np.abs(remapped.astype(float) - taken["tilted"]).mean()
    assert differs < 0.2 * np.abs(taken["upright"].astype(float) - taken["tilted"]).mean()
