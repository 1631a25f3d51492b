"""What the networks see of a panorama: the same strip, continued across its seam, as in the pipelines."""

import torch
from torch.nn import functional

from services.features.representations.equirectangular import PAD_COLUMNS
from shared.geometry.sphere import EquirectGrid

CROP_DEG, RESIZE = 25.0, (400, 800)
"""What is cut away above and below, and the rows and columns that the whole panorama would have."""


def grid_of(height_px: int) -> EquirectGrid:
    """The pixels of a strip without its continuation."""
    return EquirectGrid.cropped(2 * height_px, height_px, CROP_DEG).resized(
        RESIZE[1], EquirectGrid.cropped(RESIZE[1], RESIZE[0], CROP_DEG).height
    )


def continued(grays: torch.Tensor) -> torch.Tensor:
    """(B, 1, H, W) strips with PAD_COLUMNS of the other side beyond both edges."""
    return functional.pad(grays, (PAD_COLUMNS, PAD_COLUMNS, 0, 0), mode="circular")


def lonlat_of_strip(pixels: torch.Tensor, grid: EquirectGrid) -> torch.Tensor:
    """(..., 2) longitudes and latitudes, rad, of continuous pixels of a strip without its continuation."""
    lon = 2.0 * torch.pi * (0.5 - pixels[..., 0] / grid.width)
    lat = torch.pi * (0.5 - (pixels[..., 1] + grid.crop_top) / grid.full_height)
    return torch.stack([lon, lat], dim=-1)
