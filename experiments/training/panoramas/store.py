"""All panoramas of many shards in a device's memory, and where each point of one is in another."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import cv2
import numpy as np
import torch

from experiments.training.data.shards import trainable
from experiments.training.panoramas.strips import CROP_DEG, RESIZE
from experiments.training.sealed import computed_once
from experiments.training.sights import BAND_RAD, SAME_M, SAME_SHARE, Sight
from services.features.representations.strip import cropped_strip
from services.launcher.client.failure import ExperimentError

CHECKED = (12, 36)
"""Rows and columns of directions by which overlap is measured."""


@dataclass(frozen=True, eq=False)
class Panoramas:
    """N panoramas, those of a shard next to one another.

    Attributes:
        strips: (N, 288, 800) grey, uint8.
        ranges_m: (N, H, W) along each ray of the whole panorama, float16.
        positions_m: (N, 3) of the cameras, world frame.
        rotations: (N, 3, 3) from the camera frame to the world.
        shard: (N,) number of the shard of each; only panoramas of one shard show one place.
        overlap: (N, N) share of the directions of each that another sees; 0 between shards, float16.
    """

    strips: torch.Tensor
    ranges_m: torch.Tensor
    positions_m: torch.Tensor
    rotations: torch.Tensor
    shard: torch.Tensor
    overlap: torch.Tensor

    def __len__(self) -> int:
        return len(self.strips)

    @property
    def device(self) -> torch.device:
        """Where they are."""
        return self.strips.device

    def seen_from(
        self, lonlat_rad: torch.Tensor, here: torch.Tensor, there: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Where what some panoramas show is in others; as `sights.projected`, in batches.

        Args:
            lonlat_rad: (P, K, 2) directions in the panoramas `here`.
            here: (P,) numbers of panoramas.
            there: (P,) numbers of the others.

        Returns:
            (P, K, 3) unit bearings in the panoramas `there`; (P, K) whether the point is seen there; (P, K)
            whether anything is known of it: nothing is where `here` shows no surface.
        """
        ranges = self.ranges_m[here[:, None], *self._pixel(lonlat_rad)].float()
        known = torch.isfinite(ranges)
        rays = bearings(lonlat_rad) @ self.rotations[here].transpose(1, 2)
        points = self.positions_m[here][:, None] + rays * torch.where(known, ranges, 1.0)[..., None]
        off = (points - self.positions_m[there][:, None]) @ self.rotations[there]
        distance = off.norm(dim=-1).clamp(min=1e-6)
        seen = off / distance[..., None]
        row, column = self._pixel(lonlat(seen))
        height, width = self.ranges_m.shape[-2:]
        allowed = (SAME_SHARE * distance).clamp(min=SAME_M)
        visible = torch.zeros_like(known)
        for dy in (-1, 0, 1):
            for dx in (-1, 0, 1):
                near = self.ranges_m[there[:, None], (row + dy).clamp(0, height - 1), (column + dx) % width]
                visible |= (near.float() - distance).abs() <= allowed
        return seen, visible & known, known

    def _pixel(self, lonlat_rad: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        height, width = self.ranges_m.shape[-2:]
        column = (width * (0.5 - lonlat_rad[..., 0] / (2.0 * torch.pi))).long() % width
        row = (height * (0.5 - lonlat_rad[..., 1] / torch.pi)).long().clamp(0, height - 1)
        return row, column


def load_panoramas(
    paths: Sequence[Path], device: torch.device, threads: int = 2, kept: Path | None = None
) -> Panoramas:
    """Read shards, a few at a time.

    Args:
        paths: of the shards.
        device: where all of them are to be.
        threads: shards read at a time.
        kept: folder in which the overlaps of these shards are kept once they are known.

    Raises:
        ExperimentError: a shard is corrupted, or of a world by which training is judged, or all are empty.
    """
    strips, ranges, positions, rotations, shards = [], [], [], [], []
    for number, sights in enumerate(_read(paths, threads)):
        if not sights:  # its world had no room
            continue
        strips.append(torch.from_numpy(np.stack([_strip(sight) for sight in sights])).to(device))
        ranges.append(torch.from_numpy(np.stack([s.ranges_m for s in sights]).astype(np.float16)).to(device))
        positions += [sight.pose.position_m for sight in sights]
        rotations += [sight.pose.rotation for sight in sights]
        shards += [number] * len(sights)
    if not shards:
        raise ExperimentError(f"no pair in any of {len(paths)} shards: draw more with 'topnav train data'")
    whole = Panoramas(
        torch.cat(strips),
        torch.cat(ranges),
        torch.from_numpy(np.array(positions, np.float32)).to(device),
        torch.from_numpy(np.array(rotations, np.float32)).to(device),
        torch.tensor(shards, device=device),
        torch.zeros(len(shards), len(shards), dtype=torch.float16, device=device),
    )
    if kept is None:
        _measure_overlap(whole)
        return whole
    known = computed_once(kept, "overlap", lambda: {"overlap": _measure_overlap(whole).cpu().numpy()})
    whole.overlap.copy_(torch.from_numpy(known["overlap"]))
    return whole


def bearings(lonlat_rad: torch.Tensor) -> torch.Tensor:
    """(..., 2) longitudes and latitudes to (..., 3) unit vectors."""
    lon, lat = lonlat_rad.unbind(-1)
    return torch.stack([lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin()], dim=-1)


def lonlat(vectors: torch.Tensor) -> torch.Tensor:
    """(..., 3) unit vectors to (..., 2) longitudes and latitudes."""
    x, y, z = vectors.unbind(-1)
    return torch.stack([torch.atan2(y, x), torch.asin(z.clamp(-1.0, 1.0))], dim=-1)


def _read(paths: Sequence[Path], threads: int) -> Iterator[list[Sight]]:
    with ThreadPoolExecutor(threads) as pool:
        rest = iter(paths)
        waiting = [pool.submit(_sights, path) for path in islice(rest, threads)]
        while waiting:
            yield waiting.pop(0).result()
            waiting += [pool.submit(_sights, path) for path in islice(rest, 1)]


def _sights(path: Path) -> list[Sight]:
    return [sight for pair in trainable(path).pairs for sight in (pair.here, pair.there)]


def _strip(sight: Sight) -> np.ndarray:
    gray = np.asarray(cv2.cvtColor(sight.picture, cv2.COLOR_BGR2GRAY), np.uint8)
    return cropped_strip(gray, CROP_DEG, RESIZE)[0]


def _measure_overlap(whole: Panoramas) -> torch.Tensor:
    """Fill in the table of overlaps, a row of a shard at a time, and return it."""
    rows, columns = CHECKED
    device = whole.device
    height = torch.sin(torch.tensor(BAND_RAD)) * (2.0 * (torch.arange(rows) + 0.5) / rows - 1.0)
    turn = 2.0 * torch.pi * (torch.arange(columns) + 0.5) / columns - torch.pi
    directions = torch.stack(torch.meshgrid(turn, torch.asin(height), indexing="ij"), dim=-1).reshape(-1, 2)
    for number in whole.shard.unique().tolist():
        inside = torch.nonzero(whole.shard == number)[:, 0]
        for here in inside:
            asked = directions.to(device).expand(len(inside), -1, -1)
            _, visible, _ = whole.seen_from(asked, here.expand(len(inside)), inside)
            whole.overlap[here, inside] = visible.float().mean(1).half()
    return whole.overlap
