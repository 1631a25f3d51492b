"""What is drawn for a step of training comes from its generator alone; pictures are altered as asked."""

import numpy as np
import pytest
import torch

from experiments.training.detector.recipe import KeypointsRecipe, altered, batch_loss, beginning
from experiments.training.panoramas.drawing import Pairs

PLAIN = KeypointsRecipe(batch=1, points=32, keypoints=32, contrast=0.0, noise=0.0)


def changed(strips, shifts, recipe=PLAIN, seed=1):
    generator = torch.Generator().manual_seed(seed)
    return altered(strips, torch.tensor(shifts), recipe, np.random.default_rng(seed), generator)


def test_a_batch_comes_from_its_generator_and_from_nothing_else(places):
    trained, recipe = beginning(PLAIN), PLAIN.model_copy(update={"contrast": 0.6, "noise": 0.03})
    pairs = Pairs(places.panoramas, 0.1, 6.0)
    found = []
    for number, seed in enumerate((1, 1, 2)):
        torch.manual_seed(number)
        before = torch.random.get_rng_state()
        with torch.no_grad():
            found.append(batch_loss(trained, places.panoramas, pairs, recipe, np.random.default_rng(seed)))
        assert torch.equal(torch.random.get_rng_state(), before)
    assert torch.equal(found[0], found[1])
    assert not torch.equal(found[0], found[2])


def test_parameters_begin_by_the_seed_alone():
    torch.manual_seed(1)
    one = beginning(PLAIN).state_dict()
    torch.manual_seed(2)
    two = beginning(PLAIN).state_dict()
    assert all(torch.equal(one[name], two[name]) for name in one)


def test_nothing_asked_for_leaves_the_pictures_as_they_are(places):
    strips = places.panoramas.strips[:2]
    np.testing.assert_allclose(changed(strips, [0, 0])[:, 0].numpy(), strips.numpy() / 255.0, atol=1.1e-4)


def test_pictures_are_turned_to_the_right_each_by_its_own_columns(places):
    strips = places.panoramas.strips[:3]
    plain, turned = changed(strips, [0, 0, 0]), changed(strips, [5, 0, 793])
    assert torch.equal(turned[0, 0, :, 5:], plain[0, 0, :, :-5])
    assert torch.equal(turned[0, 0, :, :5], plain[0, 0, :, -5:])
    assert torch.equal(turned[1], plain[1])
    assert torch.equal(turned[2, 0, :, :-7], plain[2, 0, :, 7:])


@pytest.mark.parametrize("what", [{"contrast": 0.6}, {"noise": 0.1}])
def test_light_and_noise_differ_from_picture_to_picture_and_stay_within_bounds(places, what):
    strips = places.panoramas.strips[:1].expand(3, -1, -1)
    found = changed(strips, [0, 0, 0], PLAIN.model_copy(update=what))
    off = (found - changed(strips, [0, 0, 0])).abs().mean((1, 2, 3))
    assert len({round(float(value), 5) for value in off}) == 3
    assert float(off.max()) > 0.005
    assert 0.0 <= float(found.min()) < float(found.max()) <= 1.0
