"""LightGlue (Lindenberger et al. 2023): matching by attention, as kornia has it."""

from collections.abc import Sequence

import kornia.feature as kf
import numpy as np
import torch

from services.features.networks.runtime import HEIGHT_PX, WIDTH_PX, device_named, loading, pixels_of
from services.features.pipeline.interfaces import Distance, FeatureSet, Matched, Profile, Runtime
from services.features.pipeline.named_pipelines import LIGHTGLUE


class LightGlue:
    """Mutual assignments above the network's own threshold."""

    def __init__(self, profile: Profile, distance: Distance, runtime: Runtime) -> None:
        del distance
        self._device = device_named(runtime.device)
        features = LIGHTGLUE[profile.extractor]
        self._network = _build(features, trained=runtime.trained).to(self._device).eval()
        self._size = torch.tensor([[WIDTH_PX, HEIGHT_PX]], dtype=torch.float32, device=self._device)

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame."""
        one = self._picture(query)
        pairs = []
        for other in others:
            if len(query) == 0 or len(other) == 0:
                pairs.append(Matched.alike(np.zeros((0, 2), dtype=np.intp)))
                continue
            with torch.inference_mode():
                found = self._network({"image0": one, "image1": self._picture(other)})["matches"][0]
            pairs.append(Matched.alike(found.cpu().numpy().astype(np.intp).reshape(-1, 2)))
        return pairs

    def _picture(self, features: FeatureSet) -> dict[str, torch.Tensor]:
        return {
            "keypoints": pixels_of(features.lonlat_rad, self._device),
            "descriptors": torch.as_tensor(
                features.descriptors[None].astype(np.float32), device=self._device
            ),
            "image_size": self._size,
        }


def _build(features: str, *, trained: bool) -> torch.nn.Module:
    if trained:
        with loading(f"lightglue-{features.removesuffix('b')}"):
            return kf.LightGlue(features)
    known = kf.LightGlue.features[features]
    return kf.LightGlue(None, **{key: value for key, value in known.items() if key != "weights"})
