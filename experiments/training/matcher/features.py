"""The keypoints of all panoramas as tensors: of a pipeline without a network, or of our own detector."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch

from experiments.training.data.shards import trainable
from experiments.training.panoramas.store import Panoramas
from experiments.training.panoramas.strips import continued, grid_of, lonlat_of_strip
from experiments.work.workers import workers
from services.features.networks.attention import Keypoints, context_of
from services.features.networks.spherical_keypoints import KeypointNet, described, strongest
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.features.representations.equirectangular import PAD_COLUMNS
from services.launcher.client.failure import ExperimentError

BATCH = 32
"""Panoramas that a network sees at a time."""


@dataclass(frozen=True, eq=False)
class FeatureTable:
    """K keypoints of each of N panoramas, those that are missing at the end.

    Attributes:
        lonlat_rad: (N, K, 2).
        descriptors: (N, K, D), float16.
        context: (N, K, CONTEXT).
        present: (N, K).
    """

    lonlat_rad: torch.Tensor
    descriptors: torch.Tensor
    context: torch.Tensor
    present: torch.Tensor

    def of(self, numbers: torch.Tensor) -> Keypoints:
        """A batch of panoramas."""
        return Keypoints(
            self.lonlat_rad[numbers],
            self.descriptors[numbers].float(),
            self.context[numbers],
            self.present[numbers],
        )

    def to(self, device: torch.device) -> "FeatureTable":
        """The same elsewhere."""
        parts = self.lonlat_rad, self.descriptors, self.context, self.present
        return FeatureTable(*(part.to(device) for part in parts))


def extracted(paths: Sequence[Path], pipeline: str, keypoints: int, jobs: int) -> FeatureTable:
    """Keypoints of all panoramas of shards, by a pipeline's name.

    Raises:
        ExperimentError: a shard is corrupted, or of a world by which training is judged, or all are empty.
    """
    with workers(jobs, None) as pool:
        parts = list(pool.map(_of_shard, paths, [pipeline] * len(paths), [keypoints] * len(paths)))
    filled = [part for part in parts if part]
    if not filled:
        raise ExperimentError(f"no pair in any of {len(paths)} shards: draw more with 'topnav train data'")
    return FeatureTable(*(torch.from_numpy(np.concatenate(column)) for column in zip(*filled, strict=True)))


def found_by(network: KeypointNet, panoramas: Panoramas, keypoints: int) -> FeatureTable:
    """Keypoints of all panoramas by our own detector, as its extractor finds them."""
    parts = []
    with torch.inference_mode():
        for numbers in torch.arange(len(panoramas), device=panoramas.device).split(BATCH):
            parts.append(_by_network(network, panoramas, numbers, keypoints))
    return FeatureTable(*(torch.cat(column) for column in zip(*parts, strict=True)))


def _by_network(
    network: KeypointNet, panoramas: Panoramas, numbers: torch.Tensor, keypoints: int
) -> tuple[torch.Tensor, ...]:
    grays = panoramas.strips[numbers][:, None].float() / 255.0
    scores, maps = network(continued(grays))
    pixels, values = strongest(scores.float(), keypoints, PAD_COLUMNS)
    vectors = described(maps, network.strides, pixels)
    grid = grid_of(panoramas.ranges_m.shape[-2])
    own = pixels - torch.tensor([PAD_COLUMNS, 0.0], device=pixels.device)
    lonlat_rad = lonlat_of_strip(own, grid)
    context = np.stack(
        [
            context_of(FeatureSet(where, strength, np.zeros((len(strength), 0))))
            for where, strength in zip(lonlat_rad.cpu().numpy(), values.sigmoid().cpu().numpy(), strict=True)
        ]
    )
    present = torch.isfinite(values)
    return lonlat_rad, vectors.half(), torch.from_numpy(context).to(numbers.device), present


def _of_shard(path: Path, name: str, keypoints: int) -> tuple[np.ndarray, ...]:
    """Columns of a table; none of a shard whose world had no room."""
    pipeline = Pipeline(replace(find_profile(name), keypoints=keypoints))
    rows = []
    for pair in trainable(path).pairs:
        for sight in (pair.here, pair.there):
            found = extract(sight.picture, pipeline.extractor, pipeline.representation, pipeline.profile)
            rows.append(_filled(found, keypoints))
    return tuple(np.stack(column) for column in zip(*rows, strict=True))


def _filled(found: FeatureSet, keypoints: int) -> tuple[np.ndarray, ...]:
    count = min(len(found), keypoints)
    vectors = found.descriptors[:count].astype(np.float32)
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-6)
    columns = found.lonlat_rad[:count], vectors.astype(np.float16), context_of(found)[:count]
    missing = [(0, keypoints - count), (0, 0)]
    return *(np.pad(column, missing) for column in columns), np.arange(keypoints) < count
