"""A descriptor of patches learns, and goes on after an interruption to the same bits."""

import numpy as np
import pytest
import torch

from experiments.training.learning.running import Schedule
from experiments.training.patch.recipe import PatchRecipe, batch_loss, network_of
from experiments.training.patch.training import read, train
from experiments.training.recipe import recipe_from
from experiments.training.worlds import first_worlds
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.patch.painted import noise, write_painted

CPU = torch.device("cpu")
RECIPE = PatchRecipe(shape="slim", batch=24, schedule=Schedule(steps=6, kept_every=2, threads=1))
PATCHES = noise(96, panoramas=8, worlds=2)


def trained(folder, until=None, recipe=RECIPE):
    network, _ = train(PATCHES, recipe, folder, CPU, until)
    return network.state_dict()


def test_interrupted_training_goes_on_to_the_same_bits(tmp_path):
    torch.manual_seed(1)
    whole = trained(tmp_path / "whole")
    torch.manual_seed(2)
    trained(tmp_path / "pieces", 3)
    pieces = trained(tmp_path / "pieces")
    assert all(torch.equal(whole[name], pieces[name]) for name in whole)
    assert not torch.equal(whole["features.0.weight"], network_of(RECIPE).state_dict()["features.0.weight"])


def test_the_global_generator_of_torch_is_left_alone():
    torch.manual_seed(5)
    expected = torch.rand(1)
    torch.manual_seed(5)
    batch_loss(network_of(RECIPE), PATCHES, RECIPE, np.random.default_rng(1))
    assert torch.equal(torch.rand(1), expected)


def test_training_lowers_the_loss(tmp_path):
    longer = RECIPE.model_copy(
        update={"batch": 48, "schedule": Schedule(steps=25, kept_every=25, rate=3e-3, threads=1)}
    )
    begin, end = network_of(longer), network_of(longer)
    end.load_state_dict(trained(tmp_path, recipe=longer))
    with torch.no_grad():
        before, after = (batch_loss(net, PATCHES, longer, np.random.default_rng(1)) for net in (begin, end))
    assert after < 0.8 * before


def test_second_order_similarity_is_for_sosnet_unless_asked_for():
    assert PatchRecipe(shape="sosnet").likeness == 1.0
    assert PatchRecipe(shape="hardnet").likeness == 0.0
    assert PatchRecipe(shape="slim", second_order=0.5).likeness == 0.5
    network = network_of(RECIPE)
    plain, more = (
        batch_loss(network, PATCHES, recipe, np.random.default_rng(1))
        for recipe in (RECIPE, RECIPE.model_copy(update={"second_order": 0.5}))
    )
    assert more > plain


def test_mirrored_pairs_are_still_pairs():
    """Both sides are the same: mirrored alike, they still are."""
    same = noise(48, panoramas=8)
    same.pictures[:, 1] = same.pictures[:, 0]
    network = network_of(RECIPE).eval()
    with torch.no_grad():
        losses = [
            float(batch_loss(network, same, RECIPE.model_copy(update={"mirrored": share}), rng))
            for share, rng in ((share, np.random.default_rng(3)) for share in (0.0, 0.5, 1.0))
        ]
    assert len({round(loss, 6) for loss in losses}) == 3
    assert max(losses) - min(losses) < 0.1


@pytest.mark.parametrize(
    ("name", "value"), [("shape", "hardnet8"), ("batch", 1), ("margin", 0.0), ("mirrored", 1.5)]
)
def test_a_recipe_of_nothing_is_refused_by_name(name, value):
    with pytest.raises(ExperimentError, match=name):
        recipe_from(PatchRecipe, None, **{name: value})


def test_pictures_without_common_corners_are_refused(tmp_path):
    (world,) = first_worlds("development", 1)
    shard = write_painted(tmp_path, world, [])
    with pytest.raises(ExperimentError, match="hardly a corner is seen twice"):
        read([shard], tmp_path / "into", RECIPE, 1)
