"""Networks of patches: kornia's parameters by name and value, and what does not change a descriptor."""

import kornia.feature as kf
import pytest
import torch

from services.features.networks.patch_shapes import network_named


def patches(count: int) -> torch.Tensor:
    return torch.rand((count, 1, 32, 32), generator=torch.Generator().manual_seed(1))


def after_some_steps(network: torch.nn.Module) -> torch.nn.Module:
    """With statistics of batches, which are 0 and 1 at first."""
    network.train()
    with torch.no_grad():
        network(patches(16))
    return network.eval()


@pytest.mark.parametrize(("shape", "theirs"), [("hardnet", kf.HardNet), ("sosnet", kf.SOSNet)])
def test_weights_and_descriptors_are_those_of_kornia(shape, theirs):
    ours, kornias = after_some_steps(network_named(shape)), theirs(pretrained=False).eval()
    assert not torch.allclose(kornias(patches(3)), ours(patches(3)), atol=1e-2)
    kornias.load_state_dict(ours.state_dict())
    again = network_named(shape).eval()
    again.load_state_dict(kornias.state_dict())
    seen = torch.cat([patches(5), torch.full((1, 1, 32, 32), 0.4)])
    torch.testing.assert_close(kornias(seen), ours(seen), atol=1e-5, rtol=0.0)
    torch.testing.assert_close(again(seen), ours(seen), atol=0.0, rtol=0.0)


@pytest.mark.parametrize("shape", ["hardnet", "sosnet", "slim"])
def test_descriptors_are_unit_vectors_whatever_the_exposure(shape):
    network = after_some_steps(network_named(shape))
    with torch.no_grad():
        plain, exposed = network(patches(6)), network(0.2 + 0.5 * patches(6))
    assert plain.shape == (6, 128)
    torch.testing.assert_close(plain.norm(dim=1), torch.ones(6))
    torch.testing.assert_close(exposed, plain, atol=1e-2, rtol=0.0)


def test_the_slim_one_has_a_quarter_of_the_channels():
    slim, whole = network_named("slim"), network_named("hardnet")
    for one, other in zip(slim.features, whole.features, strict=True):
        assert type(one) is type(other)
        if isinstance(one, torch.nn.Conv2d) and one.kernel_size == (3, 3):
            assert 4 * one.out_channels == other.out_channels
    assert sum(value.numel() for value in slim.parameters()) < 300_000
