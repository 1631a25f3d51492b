"""A replayed loss and its gradients are those of the network as it is now, for batches of any size."""

import pytest
import torch

from experiments.training.learning.replaying import Replayed

DEVICES = [
    "cpu",
    pytest.param("cuda", marks=pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU")),
]


def squares(network: torch.nn.Module, inputs: torch.Tensor, wanted: torch.Tensor) -> torch.Tensor:
    return ((network(inputs) - wanted) ** 2).mean()


@pytest.mark.parametrize("device", DEVICES)
def test_loss_and_gradients_are_those_of_every_batch(device):
    torch.manual_seed(1)
    network = torch.nn.Linear(3, 2).to(device)
    optimiser, replayed = torch.optim.Adam(network.parameters(), 0.1), Replayed(network, squares)
    for size in (4, 7, 4, 7, 4):
        batch = torch.randn(size, 3, device=device), torch.randn(size, 2, device=device)
        found = []
        for loss_of in (lambda *both: squares(network, *both), replayed):
            optimiser.zero_grad()
            loss = loss_of(*batch)
            loss.backward()
            found.append([loss.detach().clone(), *(value.grad.clone() for value in network.parameters())])
        for plain, again in zip(*found, strict=True):
            torch.testing.assert_close(plain, again)
        optimiser.step()
