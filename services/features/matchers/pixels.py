"""Places of keypoints as learned matchers expect them: pixels of one flat picture."""

import numpy as np
import numpy.typing as npt
import torch

from shared.geometry.sphere import EquirectGrid

WIDTH_PX = 800
HEIGHT_PX = 400


def pixels_of(lonlat_rad: npt.NDArray[np.float32], device: torch.device) -> torch.Tensor:
    """Equirectangular pixels (1, N, 2), x from 0 to WIDTH_PX, of longitudes and latitudes (N, 2)."""
    pixels = EquirectGrid(WIDTH_PX, HEIGHT_PX).pixels_from_lonlat(lonlat_rad)
    return torch.as_tensor(pixels[None], dtype=torch.float32, device=device)
