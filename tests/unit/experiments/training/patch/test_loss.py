"""The losses of a few vectors are those of paper and pencil."""

import pytest
import torch

from experiments.training.patch.loss import distances, hardest_in_batch, second_order


def circle(*degrees: float) -> torch.Tensor:
    angles = torch.deg2rad(torch.tensor(degrees))
    return torch.stack([angles.cos(), angles.sin()], dim=1)


def chord(degrees: float) -> float:
    return float(2.0 * torch.sin(torch.deg2rad(torch.tensor(degrees / 2.0))))


def test_the_hardest_of_both_sides_counts():
    first, second = circle(0.0, 90.0, 200.0), circle(10.0, 70.0, 190.0)
    expected = [
        1.0 + chord(10) - chord(70),  # the first's, to the second's partner
        1.0 + chord(20) - chord(70),  # its partner, to the first
        max(0.0, 1.0 + chord(10) - chord(100)),  # its partner, to the second
    ]
    assert hardest_in_batch(first, second, 1.0).tolist() == pytest.approx(expected, abs=1e-3)
    assert hardest_in_batch(first, second, 0.1).tolist() == pytest.approx([0.0] * 3)


def test_second_order_is_how_differently_neighbours_lie():
    first, second = circle(0.0, 40.0, 180.0), circle(0.0, 100.0, 180.0)
    off = chord(100) - chord(40), chord(140) - chord(80)
    # The second is nearest to both others; to it, the first is on one side, the third on the other.
    nearest = [off[0], (off[0] ** 2 + off[1] ** 2) ** 0.5, off[1]]
    assert second_order(first, second, 1).tolist() == pytest.approx(nearest, abs=2e-3)
    assert second_order(first, first, 2).tolist() == pytest.approx([0.0] * 3, abs=2e-3)


def test_equal_vectors_have_a_slope():
    both = circle(0.0, 120.0).requires_grad_()
    (hardest_in_batch(both, both.detach(), 2.0).sum() + second_order(both, both, 1).sum()).backward()
    assert torch.isfinite(both.grad).all()
    assert float(distances(both, both).detach().diagonal().max()) < 2e-3
