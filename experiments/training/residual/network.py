"""Root SIFT plus what a small network adds, seeing the descriptor, its latitude, size and strength.

As in residual learning for image point descriptors: the detector and what it describes stay, only the
difference is learned. It begins at nothing, so that the first step is root SIFT itself.
"""

import numpy as np
import numpy.typing as npt
import torch

from services.features.pipeline.interfaces import FeatureSet

WIDTH, CONTEXT = 128, 4
"""Numbers of a descriptor, in and out, and of what is known beside it."""
SIZE_RAD, SCORE = 0.05, 0.1
"""Typical size and strength of SIFT's keypoints, so that their logarithms are about 0."""


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


def context_of(features: FeatureSet) -> npt.NDArray[np.float32]:
    """(N, 4): sine of the latitude and its square, and logarithms of size and strength."""
    sizes = np.full(len(features), SIZE_RAD) if features.sizes_rad is None else features.sizes_rad
    height = np.sin(features.lonlat_rad[:, 1])
    columns = (
        height,
        height**2,
        np.log(np.maximum(sizes, 1e-4) / SIZE_RAD),
        np.log(np.maximum(features.scores, 1e-6) / SCORE),
    )
    return np.stack(columns, axis=-1).astype(np.float32)
