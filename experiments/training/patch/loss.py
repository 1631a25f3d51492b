"""Losses of descriptors: the hardest of a batch are told apart, and both sides see the same likeness."""

import torch

FAR = 10.0
"""More than unit vectors are ever apart."""
LEAST = 1e-6
"""Squared distance below which there is no slope: that of a root is infinite at 0."""


def distances(first: torch.Tensor, second: torch.Tensor) -> torch.Tensor:
    """(N, M) between (N, D) and (M, D) unit vectors."""
    return torch.sqrt(torch.clamp(2.0 - 2.0 * first @ second.T, min=LEAST))


def hardest_in_batch(first: torch.Tensor, second: torch.Tensor, margin: float) -> torch.Tensor:
    """Loss (N,) of partners, (N, D) unit vectors each.

        max(0, margin + |a_i - b_i| - min over j other than i of |a_i - b_j| and |a_j - b_i|)

    Mishchuk et al. 2017, equation 4.
    """
    apart = distances(first, second)
    others = apart + FAR * torch.eye(len(apart), device=apart.device)
    hardest = torch.minimum(others.min(dim=0).values, others.min(dim=1).values)
    return torch.relu(margin + apart.diagonal() - hardest)


def second_order(first: torch.Tensor, second: torch.Tensor, neighbours: int) -> torch.Tensor:
    """How differently both sides see what is alike, (N,), of (N, D) unit vectors each.

        root of the sum over j of (|a_i - a_j| - |b_i - b_j|)^2

    over those j that are of the nearest neighbours of i on either side (Tian et al. 2019, equation 4).
    """
    own = distances(first, first), distances(second, second)
    chosen = torch.zeros_like(own[0], dtype=torch.bool)
    for apart in own:
        others = apart.detach() + FAR * torch.eye(len(apart), device=apart.device)
        nearest = others.topk(min(neighbours, len(apart) - 1), largest=False).indices
        chosen = chosen.scatter(1, nearest, True)
    off = torch.where(chosen, own[0] - own[1], torch.zeros_like(own[0]))
    return torch.sqrt((off**2).sum(dim=1) + LEAST)
