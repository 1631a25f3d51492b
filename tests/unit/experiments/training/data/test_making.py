"""A shard from a rendered world: what its ranges say is the same looks the same."""

import numpy as np
import pytest

from experiments.training.data.drawing import draw_pairs
from experiments.training.data.drawn import make_missing, plan_shards
from experiments.training.data.making import make_shard
from experiments.training.data.recipe import DataRecipe
from experiments.training.data.shards import trainable
from experiments.training.sights import projected
from experiments.training.worlds import first_worlds
from shared.geometry.sphere import EquirectGrid

WIDTH = 256


def colours(sight, lonlat_rad):
    pixels = EquirectGrid(WIDTH, WIDTH // 2).pixels_from_lonlat(lonlat_rad).astype(int)
    return sight.picture[pixels[:, 1], pixels[:, 0]].astype(float)


@pytest.mark.render
def test_what_corresponds_looks_the_same_and_a_second_run_makes_nothing(tmp_path):
    worlds = first_worlds("development", 1, ["flat"], ["small"])
    plain = DataRecipe.plain(3, (0.4, 1.0))
    recipe = plain.model_copy(update={"width_px": WIDTH, "negatives": 0.0, "tilt_rad": 0.1})
    (plan,) = plan_shards(worlds, "development", 1, 3, recipe, tmp_path)
    assert make_shard(plan) == 3
    assert make_missing([plan], 1) == []
    shard = trainable(plan.done)
    rng = np.random.default_rng(1)
    for pair in shard.pairs:
        assert 0.4 <= pair.distance_m <= 1.0
        assert min(pair.overlap) > 0.3
        start = np.stack([rng.uniform(-np.pi, np.pi, 400), rng.uniform(-1.0, 1.0, 400)], axis=-1)
        end, visible = projected(start, pair.here, pair.there)
        here = colours(pair.here, start[visible])
        same = np.abs(here - colours(pair.there, end[visible])).mean()
        other = np.abs(here - colours(pair.there, start[visible])).mean()
        assert same < 0.5 * other
    draw_pairs(tmp_path / "pairs.png", shard.pairs)
    assert (tmp_path / "pairs.png").stat().st_size > 10_000
