"""Detector and descriptor in one pass over a strip of a panorama. Plain torch modules.

A network gives a score for each pixel, the logit of the probability that this point is found and matched
right in another picture of the place, and a map of descriptors. `Slim` is of the size of XFeat (Potje et al.
2024), `SuperPointShaped` has the layers of SuperPoint (DeTone et al. 2018) and nothing of its weights.
"""

from typing import Literal

import torch
from torch import nn
from torch.nn import functional

Shape = Literal["slim", "superpoint"]
PHASE = 32
"""Rows and columns are filled up to a multiple of this: five halvings."""
RADIUS_PX = 2
"""Nearer to a stronger keypoint there is none."""


Maps = tuple[torch.Tensor, ...]


class KeypointNet(nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    """What both shapes have in common.

    Attributes:
        dimension: of the descriptors.
        strides: pixels per cell of each map whose sum, at a keypoint, is its descriptor.
    """

    dimension: int
    strides: tuple[int, ...]

    def maps(self, grays: torch.Tensor) -> tuple[torch.Tensor, Maps]:
        """Of (B, 1, H, W), multiples of PHASE: scores (B, H, W) and maps (B, D, H/s, W/s)."""
        raise NotImplementedError

    def forward(self, grays: torch.Tensor) -> tuple[torch.Tensor, Maps]:
        """Scores (B, H, W) and maps (B, D, about H/s, W/s) of (B, 1, H, W), 0 to 1."""
        height, width = grays.shape[-2:]
        filled = functional.pad(grays, (0, -width % PHASE, 0, -height % PHASE), mode="replicate")
        middle, spread = filled.mean((-2, -1), keepdim=True), filled.std((-2, -1), keepdim=True)
        scores, maps = self.maps((filled - middle) / (spread + 1e-3))
        return scores[:, :height, :width], maps


class Slim(KeypointNet):
    """64 numbers: what a quarter of the resolution shows, and more that an eighth and coarser levels know."""

    dimension, strides = 64, (4, 8)

    def __init__(self) -> None:
        super().__init__()
        self.stage2 = nn.Sequential(_layer(1, 8, 2), _layer(8, 16))
        self.stage4 = nn.Sequential(_layer(16, 32, 2), _layer(32, 32))
        self.stage8 = nn.Sequential(_layer(32, 64, 2), _layer(64, 64))
        self.stage16 = nn.Sequential(_layer(64, 64, 2), _layer(64, 64))
        self.stage32 = nn.Sequential(_layer(64, 96, 2), _layer(96, 96), _layer(96, 64, kernel=1))
        self.joined8, self.narrowed = _layer(64, 64), _layer(64, 32, kernel=1)
        self.joined4 = _layer(32, 32)
        self.described4 = nn.Conv2d(32, self.dimension, 1)
        self.described8 = nn.Sequential(_layer(64, 64), nn.Conv2d(64, self.dimension, 1))
        self.scored4 = nn.Sequential(_layer(32, 16), nn.Conv2d(16, 16, 1))
        self.scored2 = nn.Sequential(_layer(16, 8), nn.Conv2d(8, 4, 1))

    def maps(self, grays: torch.Tensor) -> tuple[torch.Tensor, Maps]:
        """Scores join what half the resolution shows with what the descriptors see."""
        two = self.stage2(grays)
        four = self.stage4(two)
        eight = self.stage8(four)
        sixteen = self.stage16(eight)
        eight = self.joined8(eight + _up(sixteen + _up(self.stage32(sixteen))))
        four = self.joined4(four + _up(self.narrowed(eight)))
        scores = functional.pixel_shuffle(self.scored4(four), 4) + functional.pixel_shuffle(
            self.scored2(two), 2
        )
        return scores[:, 0], (self.described4(four), self.described8(eight))


class SuperPointShaped(KeypointNet):
    """SuperPoint's encoder and heads: 256 numbers at an eighth of the resolution."""

    dimension, strides = 256, (8,)

    def __init__(self) -> None:
        super().__init__()
        levels: list[nn.Module] = []
        for number, (into, out) in enumerate(((1, 64), (64, 64), (64, 128), (128, 128))):
            levels += [nn.MaxPool2d(2)] if number else []
            levels += [_layer(into, out), _layer(out, out)]
        self.encoder = nn.Sequential(*levels)
        self.scored = nn.Sequential(_layer(128, 256), nn.Conv2d(256, 64, 1))
        self.described = nn.Sequential(_layer(128, 256), nn.Conv2d(256, self.dimension, 1))

    def maps(self, grays: torch.Tensor) -> tuple[torch.Tensor, Maps]:
        """64 scores for the 8 x 8 pixels of each cell."""
        shared = self.encoder(grays)
        return functional.pixel_shuffle(self.scored(shared), 8)[:, 0], (self.described(shared),)


def network_of(shape: Shape) -> KeypointNet:
    """A network with whatever parameters torch's generator draws."""
    return SuperPointShaped() if shape == "superpoint" else Slim()


def described(maps: Maps, strides: tuple[int, ...], pixels: torch.Tensor) -> torch.Tensor:
    """Unit descriptors (B, N, D) at (B, N, 2) continuous pixels, the centre of the first at 0.5."""
    total = torch.zeros((), device=pixels.device)
    for map_, stride in zip(maps, strides, strict=True):
        size = torch.tensor(map_.shape[:-3:-1], device=pixels.device, dtype=pixels.dtype)
        places = (2.0 * pixels / (stride * size) - 1.0)[:, None].to(map_.dtype)
        total = (
            total + functional.grid_sample(map_, places, align_corners=False, padding_mode="border").float()
        )
    return functional.normalize(total[:, :, 0].transpose(1, 2), dim=-1)


def strongest(scores: torch.Tensor, most: int, margin_px: int = 0) -> tuple[torch.Tensor, torch.Tensor]:
    """Peaks of (B, H, W) scores.

    Args:
        scores: of each pixel.
        most: keypoints of each picture.
        margin_px: columns on either side that repeat the other side, and are left out.

    Returns:
        (B, most, 2) continuous pixels, the centre of the first at 0.5, refined by a parabola along each axis,
        and (B, most) scores, falling.
    """
    batch, height, width = scores.shape
    peaks = functional.max_pool2d(scores[:, None], 2 * RADIUS_PX + 1, 1, RADIUS_PX)[:, 0]
    kept = torch.where(scores == peaks, scores, torch.full_like(scores, -torch.inf))
    kept[:, :, :margin_px] = -torch.inf
    kept[:, :, width - margin_px :] = -torch.inf
    found, index = kept.reshape(batch, -1).topk(min(most, height * width))
    row, column = index // width, index % width
    pictures = torch.arange(batch, device=scores.device)[:, None]
    shift = []
    for dy, dx in ((0, 1), (1, 0)):
        before = scores[pictures, (row - dy).clamp(min=0), (column - dx).clamp(min=0)]
        after = scores[pictures, (row + dy).clamp(max=height - 1), (column + dx).clamp(max=width - 1)]
        bend = (before - 2.0 * found + after).clamp(max=-1e-3)
        shift.append((0.5 * (before - after) / bend).nan_to_num().clamp(-0.5, 0.5))
    pixels = torch.stack([column + 0.5 + shift[0], row + 0.5 + shift[1]], dim=-1)
    return pixels, found


def _layer(into: int, out: int, stride: int = 1, kernel: int = 3) -> nn.Module:
    return nn.Sequential(
        nn.Conv2d(into, out, kernel, stride, kernel // 2, bias=False), nn.BatchNorm2d(out), nn.ReLU()
    )


def _up(map_: torch.Tensor) -> torch.Tensor:
    return functional.interpolate(map_, scale_factor=2, mode="bilinear", align_corners=False)
