"""Moved furniture: small things only, nothing overlaps, the floor stays in one piece."""

import numpy as np
import pytest

from simulator.disturbances.rearranging import KEPT_FLOOR, is_movable, rearranged
from simulator.world.changes import changed_world
from simulator.world.freespace import free_space
from simulator.world.items import Item
from simulator.world.world_file import WorldFile


@pytest.fixture(scope="module")
def parlour(room_data) -> WorldFile:
    """The plain room with six chairs, a sofa and a picture besides its table."""
    chairs = [{"kind": "chair", "at_m": [0.5 + 0.9 * k, 0.6], "yaw_deg": 90} for k in range(6)]
    others = [{"kind": "sofa", "at_m": [1.5, 3.5]}, {"kind": "picture", "at_m": [0.0, 2.0], "z_m": 1.5}]
    return WorldFile.model_validate({**room_data, "furniture": [*room_data["furniture"], *chairs, *others]})


def test_level_zero_changes_nothing(parlour):
    assert rearranged(parlour, 0.0, 1) == {}
    assert changed_world(parlour, {}) is parlour


def test_more_level_changes_more_and_the_same_seed_the_same(parlour):
    low, high = rearranged(parlour, 0.3, 1), rearranged(parlour, 1.0, 1)
    assert 0 < len(low) < len(high)
    assert "sofa-1" not in high
    assert rearranged(parlour, 1.0, 1) == high
    assert rearranged(parlour, 1.0, 2) != high


def test_floor_stays_free_and_connected(parlour):
    before = free_space(parlour, resolution_m=0.1)
    for seed in range(3):
        after = free_space(changed_world(parlour, rearranged(parlour, 1.0, seed)), resolution_m=0.1)
        assert after.free.sum() >= KEPT_FLOOR * before.free.sum()
        assert after.is_free((parlour.start.x_m, parlour.start.y_m))


def test_moved_chairs_do_not_stand_in_each_other(parlour):
    changed = changed_world(parlour, rearranged(parlour, 1.0, 4))
    chairs = np.array([item.at_m for item in changed.furniture if item.kind == "chair"])
    apart = np.linalg.norm(chairs[:, None] - chairs[None], axis=-1)[~np.eye(len(chairs), dtype=bool)]
    assert apart.min() > 0.3


@pytest.mark.parametrize(
    ("item", "movable"),
    [
        (Item(kind="chair", at_m=(1.0, 1.0)), True),
        (Item(kind="sofa", at_m=(1.0, 1.0)), False),
        (Item(kind="picture", at_m=(1.0, 1.0), z_m=1.5), False),
        (Item(kind="rug", at_m=(1.0, 1.0)), False),
    ],
)
def test_only_small_things_on_the_floor_move(item, movable):
    assert is_movable(item) is movable
