"""What a camera does to a panorama: only what was drawn, as much as the recipe allows, round the seam."""

import numpy as np
import pytest

from experiments.training.data.degrading import Degradation, degraded, drawn
from experiments.training.data.recipe import DataRecipe

HEIGHT, WIDTH = 40, 80
LINE = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
LINE[:, 0] = 200
GREY = np.full((HEIGHT, WIDTH, 3), 100, np.uint8)


def rng():
    return np.random.default_rng(3)


def test_no_degradation_leaves_the_picture():
    assert (degraded(LINE, Degradation(), rng()) == LINE).all()


@pytest.mark.parametrize("how", [Degradation(smear_px=5), Degradation(blur_px=1.5)])
def test_a_line_on_the_seam_spreads_evenly_to_both_sides_of_it(how):
    spread = degraded(LINE, how, rng()).astype(int)
    assert spread.shape == LINE.shape
    assert 0 < spread[20, 0, 0] < 200
    assert spread[20, 1, 0] == spread[20, -1, 0] > 0
    assert spread[20, WIDTH // 2, 0] == 0


def test_the_back_lens_alone_is_brighter_and_lower():
    picture = GREY.copy()
    picture[10] = 150
    joined = degraded(picture, Degradation(seam=0.1, seam_px=2), rng())
    front, back = slice(WIDTH // 4, 3 * WIDTH // 4), np.r_[: WIDTH // 4, 3 * WIDTH // 4 : WIDTH]
    assert (joined[:, front] == picture[:, front]).all()
    assert (joined[12, back] == 165).all()
    assert (joined[10, back] == 110).all()


def test_a_stop_brightens_and_noise_is_that_of_its_generator():
    assert (degraded(GREY, Degradation(stops=1.0), rng()) > 120).all()
    one, same = (degraded(GREY, Degradation(noise=0.3), rng()) for _ in range(2))
    assert (one == same).all()
    assert one.std() > 1.0


def test_what_is_drawn_is_within_the_recipe_and_each_part_off_in_half_of_the_pictures():
    recipe, source = DataRecipe(disturbed=1.0), rng()
    some = [drawn(recipe, source) for _ in range(600)]
    for name, most in (("stops", 1.0), ("blur_px", 1.2), ("smear_px", 6), ("seam", 0.08), ("noise", 0.4)):
        values = np.array([getattr(one, name) for one in some], float)
        assert 0.8 * most < np.abs(values).max() <= most
        assert 0.4 < (values == 0.0).mean() < 0.65
    assert {one.quality for one in some} == set(range(60, 96))


def test_so_many_pictures_are_degraded_at_all_as_the_recipe_says():
    source = rng()
    plain = DataRecipe.plain(1, (0.3, 6.0))
    assert {drawn(plain, source) for _ in range(50)} == {Degradation(quality=95)}
    some = [drawn(DataRecipe(disturbed=0.5), source) for _ in range(600)]
    untouched = np.mean([one == Degradation(quality=one.quality) for one in some])
    assert 0.45 < untouched < 0.6
