"""The keypoints of panoramas as tensors: of a pipeline, or of a detector that was trained here."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch

from experiments.training.panoramas.store import Panoramas
from experiments.training.panoramas.strips import continued, grid_of, lonlat_of_strip
from experiments.training.sights import Sight
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
        return FeatureTable(*(part.to(device) for part in vars(self).values()))


def table_of(found: Sequence[FeatureSet], keypoints: int) -> FeatureTable:
    """Rows for the keypoints of N panoramas, at most so many of each."""
    columns = zip(*(_filled(features, keypoints) for features in found), strict=True)
    return FeatureTable(*(torch.from_numpy(np.stack(column)) for column in columns))


def extracted(sights: Sequence[Sight], name: str, keypoints: int) -> list[FeatureSet]:
    """At most so many keypoints of each panorama, by a pipeline's name.

    Raises:
        ExperimentError: its descriptors are bits, which attention cannot weigh.
        ValueError: no such pipeline.
    """
    pipeline = Pipeline(replace(find_profile(name), keypoints=keypoints))
    if pipeline.extractor.distance == "hamming":
        raise ExperimentError(f"the descriptors of {name} are bits: a matcher is trained on numbers")
    parts = pipeline.extractor, pipeline.representation, pipeline.profile
    return [extract(sight.picture, *parts) for sight in sights]


def found_by(network: KeypointNet, panoramas: Panoramas, keypoints: int) -> list[FeatureSet]:
    """Keypoints of all panoramas by our own detector, as its extractor finds them."""
    with torch.inference_mode():
        return [
            features
            for numbers in torch.arange(len(panoramas), device=panoramas.device).split(BATCH)
            for features in _by_network(network, panoramas, numbers, keypoints)
        ]


def _by_network(
    network: KeypointNet, panoramas: Panoramas, numbers: torch.Tensor, keypoints: int
) -> list[FeatureSet]:
    grays = panoramas.strips[numbers][:, None].float() / 255.0
    scores, maps = network(continued(grays))
    pixels, values = strongest(scores.float(), keypoints, PAD_COLUMNS)
    vectors = described(maps, network.strides, pixels).half().cpu().numpy()
    own = pixels - torch.tensor([PAD_COLUMNS, 0.0], device=pixels.device)
    lonlat_rad = lonlat_of_strip(own, grid_of(panoramas.ranges_m.shape[-2])).cpu().numpy()
    present, likely = torch.isfinite(values).cpu().numpy(), values.sigmoid().cpu().numpy()
    return [
        FeatureSet(where[there], how[there], what[there])
        for where, how, what, there in zip(lonlat_rad, likely, vectors, present, strict=True)
    ]


def _filled(found: FeatureSet, keypoints: int) -> tuple[np.ndarray, ...]:
    count = min(len(found), keypoints)
    vectors = found.descriptors[:count].astype(np.float32)
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-6)
    columns = found.lonlat_rad[:count], vectors.astype(np.float16), context_of(found)[:count]
    missing = [(0, keypoints - count), (0, 0)]
    return *(np.pad(column, missing) for column in columns), np.arange(keypoints) < count
