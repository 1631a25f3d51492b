"""Root SIFT plus what a small network adds, seeing the descriptor, its latitude, size and strength.

As in residual learning for image point descriptors: the detector and what it describes stay, only the
difference is learned. It begins at nothing, so that the first step is root SIFT itself.
"""

import torch

from services.features.networks.attention import CONTEXT

WIDTH = 128
"""Numbers of a descriptor, in and out."""


class Residual(torch.nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    """(N, 128) root SIFT and (N, 4) context to (N, 128) unit vectors."""

    def __init__(self, hidden: int) -> None:
        super().__init__()
        self.inner = torch.nn.Sequential(
            torch.nn.Linear(WIDTH + CONTEXT, hidden),
            torch.nn.ReLU(),
            torch.nn.Linear(hidden, hidden),
            torch.nn.ReLU(),
            torch.nn.Linear(hidden, WIDTH),
        )
        torch.nn.init.zeros_(self.inner[-1].weight)
        torch.nn.init.zeros_(self.inner[-1].bias)

    def forward(self, descriptors: torch.Tensor, context: torch.Tensor) -> torch.Tensor:
        """Unit vectors of the same number."""
        unit = torch.nn.functional.normalize(descriptors, dim=-1)
        added = self.inner(torch.cat([unit * WIDTH**0.5, context], dim=-1))
        return torch.nn.functional.normalize(unit + added, dim=-1)
