"""Folding changes how fast a network is, and nothing of what it says."""

import pytest
from numpy.testing import assert_allclose

torch = pytest.importorskip("torch")

from services.features.networks.own_weights import folded  # noqa: E402
from services.features.networks.patch_shapes import network_named  # noqa: E402
from services.features.networks.spherical_keypoints import network_of  # noqa: E402


def used(network, batch):
    """A network whose normalisations have seen pictures."""
    network.train()
    with torch.no_grad():
        for _ in range(3):
            network(batch)
    return network.eval()


def normalisations(network) -> int:
    return sum(isinstance(layer, torch.nn.BatchNorm2d) for layer in network.modules())


def test_a_descriptor_says_the_same_without_normalisations():
    torch.manual_seed(1)
    patches = torch.rand(8, 1, 32, 32)
    network = used(network_named("slim"), patches)
    with torch.inference_mode():
        before = network(patches)
        assert normalisations(network) == 7
        after = folded(network)
        assert normalisations(after) == 0
        assert_allclose(after(patches).numpy(), before.numpy(), atol=1e-5)


def test_a_detector_says_the_same_without_normalisations():
    torch.manual_seed(1)
    pictures = torch.rand(2, 1, 64, 64)
    network = used(network_of("slim"), pictures)
    with torch.inference_mode():
        before, maps = network(pictures)
        scores, others = folded(network)(pictures)
        assert normalisations(network) == 0
    assert_allclose(scores.numpy(), before.numpy(), atol=1e-4)
    for one, other in zip(maps, others, strict=True):
        assert_allclose(other.numpy(), one.numpy(), atol=1e-4)
