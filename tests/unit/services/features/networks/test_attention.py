"""The matcher's network: what turning a camera, changing the order or filling up must not change."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

torch = pytest.importorskip("torch")

from services.features.networks.attention import ANSWERS, Attention, Keypoints, Layer, gathered  # noqa: E402


@pytest.fixture(scope="module")
def network():
    torch.manual_seed(3)
    return Attention(8, width=32).eval()


def some(count: int, seed: int) -> Keypoints:
    rng = torch.Generator().manual_seed(seed)
    lonlat = (torch.rand(1, count, 2, generator=rng) - 0.5) * torch.tensor([6.28, 2.0])
    vectors = torch.nn.functional.normalize(torch.randn(1, count, 8, generator=rng), dim=-1)
    return Keypoints(lonlat, vectors, torch.randn(1, count, 4, generator=rng))


def last(network, one: Keypoints, other: Keypoints):
    with torch.inference_mode():
        return network(one, other)[-1]


def changed(points: Keypoints, **parts) -> Keypoints:
    return Keypoints(**{**points.__dict__, **parts})


def test_turning_a_camera_changes_no_answer(network):
    one, other = some(20, 1), some(30, 2)
    turned = changed(one, lonlat_rad=one.lonlat_rad + torch.tensor([1.234, 0.0]))
    plain, found = last(network, one, other), last(network, turned, other)
    assert_allclose(found.log_right.numpy(), plain.log_right.numpy(), atol=1e-4)
    assert_allclose(found.pair.numpy(), plain.pair.numpy(), atol=1e-5)


def test_where_a_keypoint_is_among_the_others_does_matter(network):
    one, other = some(20, 1), some(30, 2)
    moved = one.lonlat_rad.clone()
    moved[0, 0, 0] += 1.0
    found = last(network, changed(one, lonlat_rad=moved), other)
    assert (found.log_right - last(network, one, other).log_right).abs().max() > 1e-3


def test_the_order_of_keypoints_is_the_order_of_the_answer_and_nothing_else(network):
    one, other, order = (
        some(20, 1),
        some(30, 2),
        torch.randperm(20, generator=torch.Generator().manual_seed(1)),
    )
    shuffled = Keypoints(one.lonlat_rad[:, order], one.descriptors[:, order], one.context[:, order])
    found = last(network, shuffled, other).log_right
    assert_allclose(found.numpy(), last(network, one, other).log_right[:, order].numpy(), atol=1e-4)


def test_which_picture_comes_first_changes_no_answer(network):
    one, other = some(20, 1), some(30, 2)
    plain, found = last(network, one, other), last(network, other, one)
    assert_allclose(found.log_right.numpy(), plain.log_right.transpose(1, 2).numpy(), atol=1e-4)
    assert_allclose(found.pair.numpy(), plain.pair.numpy(), atol=1e-5)


def test_keypoints_that_only_fill_up_change_nothing_and_are_nobodys_partner(network):
    one, other = some(20, 1), some(30, 2)
    filled = Keypoints(
        *(torch.cat([part, torch.ones_like(part[:, :5])], dim=1) for part in
          (one.lonlat_rad, one.descriptors, one.context)),
        torch.arange(25)[None] < 20,
    )  # fmt: skip
    found, plain = last(network, filled, other), last(network, one, other)
    assert_allclose(found.log_right[:, :20].numpy(), plain.log_right.numpy(), atol=1e-4)
    assert found.log_right[:, 20:].exp().max() < 1e-6
    assert_allclose(found.pair.numpy(), plain.pair.numpy(), atol=1e-5)


def test_a_partner_is_shared_by_probabilities_that_sum_to_one_at_most(network):
    right = last(network, some(20, 1), some(30, 2)).log_right.exp()
    assert right.sum(2).max() <= 1.0 + 1e-6
    assert right.sum(1).max() <= 1.0 + 1e-6


def test_the_last_answer_alone_is_that_of_all_layers(network):
    one, other = some(20, 1), some(30, 2)
    with torch.inference_mode():
        numbers, found = network.last(one, other, hopeless=0.0)
    plain = last(network, one, other)
    assert numbers == [0]
    assert found.pair.shape == (1, ANSWERS)
    assert_allclose(found.log_right.numpy(), plain.log_right.numpy(), atol=1e-5)
    assert np.isfinite(found.log_right.numpy()).all()


def test_of_many_pictures_those_found_to_be_elsewhere_are_not_asked_further_and_others_say_the_same(network):
    one, many = some(20, 1), [some(30, seed) for seed in range(2, 7)]
    short = [changed(other, present=torch.arange(30)[None] < 30 - 3 * k) for k, other in enumerate(many)]
    together = Keypoints(*(torch.cat([getattr(other, name) for other in short]) for name in vars(short[0])))
    plain = [network(one, other) for other in short]
    same = [float(answers[1].pair[0, 0].sigmoid().detach()) for answers in plain]
    middle = float(np.median(same))
    with torch.inference_mode():
        numbers, found = network.last(one, together, hopeless=middle)
        assert network.last(one, together, hopeless=1.0) == ([], None)
    assert numbers == [k for k in range(5) if same[k] >= middle]
    assert len(numbers) == 3
    for row, number in enumerate(numbers):
        expected = plain[number][-1].log_right[0].detach()
        assert_allclose(found.log_right[row].exp().numpy(), expected.exp().numpy(), atol=1e-5)


@pytest.mark.parametrize("apart", [1.0, 100.0])
def test_hearing_each_other_is_attention_from_either_side_and_never_without_number(apart):
    torch.manual_seed(5)
    layer = Layer(32, 2).eval()
    key, key_other = torch.randn(3, 2, 20, 16), torch.randn(3, 2, 30, 16)
    key[:, :, 0] *= apart  # by a hundred: the others seem silent beside what this one hears
    value, value_other = torch.randn(3, 2, 20, 16), torch.randn(3, 2, 30, 16)
    cosines = torch.rand(3, 20, 30)
    with torch.inference_mode():
        heard = layer.heard(key, key_other, cosines, None, torch.arange(30).expand(3, 30) < 25)
        found = gathered(heard, value_other), gathered(heard.transpose(2, 3), value)
        mask = layer.listening * cosines[:, None, :, :25]
        asked, others = key_other[:, :, :25], value_other[:, :, :25]
        attention = torch.nn.functional.scaled_dot_product_attention
        plain = (
            attention(key, asked, others, attn_mask=mask),
            attention(asked, key, value, attn_mask=mask.transpose(2, 3)),
        )
    assert all(bool(torch.isfinite(part).all()) for part in found)
    assert not bool(found[1][:, 25:].any())
    if apart == 1.0:
        for part, whole in zip((found[0], found[1][:, :25]), plain, strict=True):
            assert_allclose(part.numpy(), whole.transpose(1, 2).flatten(2).numpy(), atol=1e-5)
