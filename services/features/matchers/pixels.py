"""Places of keypoints as learned matchers expect them: pixels of one flat picture."""

import numpy as np
import numpy.typing as npt
import torch

WIDTH_PX = 800
HEIGHT_PX = 400


def pixels_of(lonlat_rad: npt.NDArray[np.float32], device: torch.device) -> torch.Tensor:
    """Equirectangular pixels (1, N, 2), x from 0 to WIDTH_PX, of longitudes and latitudes (N, 2)."""
    x = (np.pi - lonlat_rad[:, 0]) / (2.0 * np.pi) * WIDTH_PX
    y = (np.pi / 2 - lonlat_rad[:, 1]) / np.pi * HEIGHT_PX
    return torch.as_tensor(np.stack([x, y], axis=1)[None], dtype=torch.float32, device=device)
