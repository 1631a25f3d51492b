"""The residual: begins as root SIFT, learns, goes on after an interruption to the same bits."""

import numpy as np
import pytest
import torch

from experiments.training.learning.running import LOG, Schedule, require_same_shards, run
from experiments.training.residual.network import CONTEXT, WIDTH
from experiments.training.residual.recipe import ResidualRecipe, batch_loss, network_of, triplets
from experiments.training.residual.samples import Sample
from services.launcher.client.failure import ExperimentError

RECIPE = ResidualRecipe(hidden=16, batch=2, schedule=Schedule(steps=12, kept_every=3, rate=3e-3, threads=1))


def sample(seed: int) -> Sample:
    """Twenty keypoints whose descriptors were disturbed, all partners."""
    rng = np.random.default_rng(seed)
    first = rng.random((20, WIDTH), np.float32)
    second = first + 0.5 * rng.random((20, WIDTH), np.float32)
    contexts = rng.random((2, 20, CONTEXT), np.float32)
    return Sample(
        (first, second), (contexts[0], contexts[1]), np.stack([np.arange(20)] * 2, 1), np.eye(20, dtype=bool)
    )


SAMPLES = [sample(seed) for seed in range(4)]


def trained(folder, until=None, recipe=RECIPE):
    network = network_of(recipe)
    run(
        network,
        lambda net, rng: batch_loss(net, SAMPLES, recipe, rng),
        recipe.schedule,
        recipe,
        folder,
        until=until,
    )
    return network.state_dict()


def test_it_begins_as_root_sift():
    first = torch.from_numpy(SAMPLES[0].descriptors[0])
    with torch.no_grad():
        out = network_of(RECIPE)(first, torch.from_numpy(SAMPLES[0].contexts[0]))
    torch.testing.assert_close(out, torch.nn.functional.normalize(first, dim=-1))


def test_interrupted_training_goes_on_to_the_same_bits(tmp_path):
    whole = trained(tmp_path / "whole")
    for until in (4, 9):
        trained(tmp_path / "pieces", until)
    pieces = trained(tmp_path / "pieces")
    assert all(torch.equal(whole[name], pieces[name]) for name in whole)
    assert not torch.equal(whole["inner.0.weight"], network_of(RECIPE).state_dict()["inner.0.weight"])
    assert len(list((tmp_path / "pieces").glob("step-*"))) == 2  # the last one, and one should that break
    assert (tmp_path / "pieces" / LOG).read_text().count("\n") >= 4


def test_another_seed_gives_another_result(tmp_path):
    other = RECIPE.model_copy(update={"schedule": RECIPE.schedule.model_copy(update={"seed": 2})})
    one, two = trained(tmp_path / "one"), trained(tmp_path / "two", recipe=other)
    assert not torch.equal(one["inner.0.weight"], two["inner.0.weight"])


def test_a_corrupted_checkpoint_is_refused_by_name(tmp_path):
    trained(tmp_path, until=6)
    newest = sorted(tmp_path.glob("step-*"))[-1]
    data = bytearray(newest.read_bytes())
    data[-1] ^= 1
    newest.write_bytes(data)
    with pytest.raises(ExperimentError, match=f"{newest.name} is corrupted"):
        trained(tmp_path)


def test_a_folder_of_another_recipe_is_not_gone_on_with(tmp_path):
    trained(tmp_path, until=3)
    with pytest.raises(ExperimentError, match="another recipe"):
        trained(tmp_path, recipe=RECIPE.model_copy(update={"margin": 0.5}))


def test_a_folder_begun_with_other_pairs_is_not_gone_on_with(tmp_path):
    begun = [tmp_path / "flat-3-small-000-0123456789abcdef.npz"]
    for _ in range(2):
        require_same_shards(begun, tmp_path / "into")
    with pytest.raises(ExperimentError, match="other pairs"):
        require_same_shards([tmp_path / "flat-3-small-000-fedcba9876543210.npz"], tmp_path / "into")


def test_the_global_generator_of_torch_is_left_alone():
    torch.manual_seed(5)
    expected = torch.rand(1)
    torch.manual_seed(5)
    network_of(RECIPE)
    assert torch.equal(torch.rand(1), expected)


@pytest.mark.parametrize("name", ["steps", "rate", "kept_every", "threads"])
def test_a_schedule_of_nothing_is_refused_by_name(name):
    with pytest.raises(ValueError, match=name):
        Schedule.model_validate({name: 0})


def test_the_rate_falls_along_half_a_cosine():
    schedule = Schedule(steps=12, rate=0.2)
    assert [schedule.rate_at(step) for step in (0, 6, 12)] == pytest.approx([0.2, 0.1, 0.0])
    assert schedule.rate_at(3) == pytest.approx(0.1 + 0.1 * 0.5**0.5)


def test_training_lowers_the_loss(tmp_path):
    longer = RECIPE.model_copy(update={"schedule": Schedule(steps=60, kept_every=60, rate=3e-3, threads=1)})
    begin, end = network_of(longer), network_of(longer)
    end.load_state_dict(trained(tmp_path, recipe=longer))
    with torch.no_grad():
        before, after = (triplets(net, SAMPLES[0], 1.0).mean() for net in (begin, end))
    assert after < 0.9 * before


def test_the_loss_of_two_partners_is_that_of_paper_and_pencil():
    """Beside the partners, equal to the bit, the second picture has a keypoint 0.765 from both."""
    first = np.eye(2, dtype=np.float32)
    second = np.concatenate([first, np.full((1, 2), 0.5**0.5, np.float32)])
    none = np.zeros((3, 0), np.float32)
    plain = Sample((first, second), (none[:2], none), np.array([[0, 0], [1, 1]]), np.eye(2, 3, dtype=bool))
    to_it, from_it = 1.0 - (2.0 - 2.0**0.5) ** 0.5, 0.0  # of the first's, nothing is nearer than 2^0.5
    loss = triplets(lambda descriptors, _: descriptors, plain, 1.0)
    assert loss.tolist() == pytest.approx(
        [to_it, to_it, from_it, from_it], abs=2e-3
    )  # 1e-3: root of the clamp


def test_what_is_near_the_true_place_is_no_negative():
    one = SAMPLES[0]
    twin = Sample(
        (one.descriptors[0], np.concatenate([one.descriptors[1], one.descriptors[0][:1]])),
        (one.contexts[0], np.concatenate([one.contexts[1], one.contexts[0][:1]])),
        one.partners,
        np.concatenate([one.near, np.zeros((20, 1), bool)], axis=1),
    )
    excused = Sample(twin.descriptors, twin.contexts, twin.partners, twin.near.copy())
    excused.near[0, 20] = True
    network = network_of(RECIPE)
    with torch.no_grad():
        assert triplets(network, excused, 1.0)[0] < triplets(network, twin, 1.0)[0]
