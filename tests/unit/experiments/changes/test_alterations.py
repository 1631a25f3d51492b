"""What is drawn to be changed: pieces that people carry, gone or far enough away; which pixels show it."""

import math

import numpy as np
import pytest

from experiments.changes.alterations import LEAST_MOVE_M, draw_alteration
from experiments.changes.light import photographed
from experiments.changes.sights import SHADE, labels_of
from shared.messages.simulation import Pose
from simulator.sensors.panorama import directions
from simulator.world.changes import item_names
from simulator.world.world_file import load_world


@pytest.fixture(scope="module")
def apartment():
    return load_world("apartment")


def test_pieces_are_taken_away_or_moved_far_enough(apartment):
    rng = np.random.default_rng(1)
    drawn = [draw_alteration(apartment, rng, {"pouf-1"}) for _ in range(12)]
    assert {each.kind for each in drawn} == {"removed", "moved"}
    assert {each.name for each in drawn} <= set(item_names(apartment)) - {"pouf-1"}
    for each in drawn:
        assert (each.after is None) == (each.pose is None) == (each.kind == "removed")
        assert each.after is None or math.dist(each.before, each.after) >= LEAST_MOVE_M


def test_a_world_without_furniture_has_nothing_to_change(apartment):
    bare = apartment.model_copy(update={"furniture": ()})
    with pytest.raises(ValueError, match="nothing that could be moved"):
        draw_alteration(bare, np.random.default_rng(1), set())


def test_pixels_are_labelled_by_what_stood_or_stands_there(apartment):
    change = draw_alteration(apartment, np.random.default_rng(1), set())
    spot = change.before
    pose = Pose(x_m=spot[0] - 2.0, y_m=spot[1], yaw_rad=0.0)
    far = np.full((64, 128), 6.0, np.float32)
    near, rays = far.copy(), directions(128)
    ahead = (rays[..., 0] > 0.99) & (np.abs(rays[..., 2]) < 0.1)
    near[ahead] = 2.0
    old, new = np.zeros((64, 128, 3), np.uint8), np.zeros((64, 128, 3), np.uint8)
    new[60:] = 50
    labels = labels_of(pose, (old, near), (new, far), [change])
    assert (labels[ahead] == 1).all()
    assert (labels[60:] == SHADE).all()
    assert not labels[:60][~ahead[:60]].any()


def test_half_the_light_leaves_half_the_levels():
    grey = np.full((64, 128, 3), 120, np.uint8)
    dark = photographed(grey, 0.5, np.random.default_rng(0))
    assert 50 < dark.mean() < 70
    assert dark.std() > 0.5
