"""What a matcher learns from: keypoints as a map keeps them, and who is whose partner in other panoramas.

Computed once for each shard and kept in its folder: a training begins with them, on another machine too.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import Any, Self

import numpy as np
import torch

from experiments.training.data.shards import trainable
from experiments.training.matcher.features import FeatureTable, extracted, found_by, table_of
from experiments.training.matcher.losses import Truth, truth_of
from experiments.training.panoramas.store import Panoramas, load_panoramas
from experiments.training.sealed import computed_once
from experiments.work.workers import workers
from services.features.map_features.packing import Packing
from services.features.networks.spherical_keypoints import KeypointNet
from services.features.pipeline.interfaces import FeatureSet
from services.launcher.client.failure import ExperimentError

ALONE, UNKNOWN = -1, -2
"""In place of a partner's number: it has none, and nobody knows."""
AT_ONCE = 4
"""Pairs of panoramas whose partners are computed at a time: few, as their angles then stay in a cache."""
CPU = torch.device("cpu")

Arrays = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class Examples:
    """N panoramas with K keypoints each, those of a shard next to one another.

    Attributes:
        table: of the keypoints.
        positions_m: (N, 3) of the cameras.
        shard: (N,) number of the shard of each.
        overlap: (N, N) share of the directions of each that another sees, float16.
        begins: (N,) first panorama of the shard of each.
        rows: (N,) row of `partners` for a panorama and the first one of its shard; others follow.
        partners: (R, K) number of the same point's keypoint in the other panorama, ALONE or UNKNOWN; int16.
    """

    table: FeatureTable
    positions_m: torch.Tensor
    shard: torch.Tensor
    overlap: torch.Tensor
    begins: torch.Tensor
    rows: torch.Tensor
    partners: torch.Tensor

    def __len__(self) -> int:
        return len(self.shard)

    @property
    def device(self) -> torch.device:
        """Where they are."""
        return self.shard.device

    def to(self, device: torch.device) -> Self:
        """The same elsewhere."""
        return type(self)(*(getattr(self, field.name).to(device) for field in fields(self)))

    def truth(self, pairs: torch.Tensor, kept: torch.Tensor, kept_other: torch.Tensor) -> Truth:
        """What is right for pairs of which some keypoints are kept.

        Args:
            pairs: (P, 2) numbers of panoramas.
            kept: (P, n) numbers of the keypoints of the first of each that are there.
            kept_other: (P, m) the same of the second.
        """
        here, there = pairs.T
        first, second = self._partners(here, there), self._partners(there, here)
        places = torch.full_like(second, kept_other.shape[1])  # one column more than there are: none
        numbers = torch.arange(kept_other.shape[1], device=self.device, dtype=places.dtype)
        places.scatter_(1, kept_other, numbers.expand(len(pairs), -1))
        wanted = first.gather(1, kept)
        column = places.gather(1, wanted.clamp(min=0)).where(wanted >= 0, kept_other.shape[1])
        partners = torch.zeros(len(pairs), kept.shape[1], kept_other.shape[1] + 1, device=self.device)
        partners = partners.scatter_(2, column[..., None], 1.0)[..., :-1].bool()
        overlap = torch.minimum(self.overlap[here, there], self.overlap[there, here]).float()
        distance = (self.positions_m[here] - self.positions_m[there]).norm(dim=-1)
        alone = wanted == ALONE, second.gather(1, kept_other) == ALONE
        return Truth(partners, alone, overlap, distance.clamp(min=0.1).log())

    def _partners(self, here: torch.Tensor, there: torch.Tensor) -> torch.Tensor:
        """(P, K) partners of the keypoints of some panoramas in others."""
        same = self.shard[here] == self.shard[there]
        row = torch.where(same, self.rows[here] + there - self.begins[here], 0)
        elsewhere = torch.where(self.table.present[here], ALONE, UNKNOWN)
        return torch.where(same[:, None], self.partners[row].long(), elsewhere)


def read_examples(
    paths: Sequence[Path], name: str, keypoints: int, network: KeypointNet | None, kept: Path, jobs: int
) -> Examples:
    """Of all shards, those that an earlier training kept and others computed now.

    Args:
        paths: of the shards.
        name: of the pipeline whose keypoints are matched.
        keypoints: of a panorama, at most.
        network: our own detector, instead of the pipeline.
        kept: folder of what is computed.
        jobs: shards at a time.

    Raises:
        ExperimentError: a shard is corrupted, or of a world by which training is judged, or all are empty.
    """
    reading = partial(_of_shard, name=name, keypoints=keypoints, network=network, kept=kept)
    with workers(jobs, None) as pool:
        parts = [part for part in pool.map(reading, paths) if len(part["positions_m"])]
    if not parts:
        raise ExperimentError(f"no pair in any of {len(paths)} shards: draw more with 'topnav train data'")
    return _joined(parts, keypoints)


def _of_shard(path: Path, name: str, keypoints: int, network: KeypointNet | None, kept: Path) -> Arrays:
    torch.set_num_threads(1)  # side by side, more threads only get in each other's way
    return computed_once(kept, path.stem, partial(_computed, path, name, keypoints, network))


def _computed(path: Path, name: str, keypoints: int, network: KeypointNet | None) -> Arrays:
    sights = [sight for pair in trainable(path).pairs for sight in (pair.here, pair.there)]
    if not sights:  # its world had no room
        return {"positions_m": np.zeros((0, 3), np.float32)}
    panoramas = load_panoramas([path], CPU)
    found = found_by(network, panoramas, keypoints) if network else extracted(sights, name, keypoints)
    packing = Packing.of(found[0], keypoints, "euclidean")
    return {
        "positions_m": panoramas.positions_m.numpy(),
        "overlap": panoramas.overlap.numpy(),
        "keypoints": np.stack([packing.pack(features) for features in found]),
        "partners": partners_of(panoramas, table_of(found, keypoints)),
    }


def partners_of(panoramas: Panoramas, table: FeatureTable) -> np.ndarray:
    """(N, N, K) partners of all keypoints in every other panorama of one shard, int16.

    Where neither panorama sees anything of the other, all are alone.
    """
    count = len(panoramas)
    lone = torch.where(table.present, ALONE, UNKNOWN).to(torch.int16)
    partners = lone[:, None].repeat(1, count, 1)
    seen = torch.maximum(panoramas.overlap, panoramas.overlap.T) > 0.0
    for pairs in torch.nonzero(seen.triu(1)).split(AT_ONCE):
        here, there = pairs.T
        truth = truth_of(panoramas, pairs, table.of(here), table.of(there))
        partners[here, there] = _numbers(truth.partners, truth.alone[0])
        partners[there, here] = _numbers(truth.partners.transpose(1, 2), truth.alone[1])
    return np.asarray(partners.numpy())


def _numbers(partners: torch.Tensor, alone: torch.Tensor) -> torch.Tensor:
    others = torch.where(alone, ALONE, UNKNOWN)
    return torch.where(partners.any(2), partners.int().argmax(2), others).to(torch.int16)


def _joined(parts: Sequence[Arrays], keypoints: int) -> Examples:
    counts = [len(part["positions_m"]) for part in parts]
    begins, rows = np.cumsum([0, *counts]), np.cumsum([0, *(count**2 for count in counts)])
    shard = np.repeat(np.arange(len(parts)), counts)
    inside = np.arange(len(shard)) - begins[shard]
    overlap = np.zeros((len(shard), len(shard)), np.float16)
    for begin, count, part in zip(begins, counts, parts, strict=False):
        overlap[begin : begin + count, begin : begin + count] = part["overlap"]
    numbers: dict[str, Any] = {
        "positions_m": np.concatenate([part["positions_m"] for part in parts]),
        "shard": shard,
        "overlap": overlap,
        "begins": begins[shard],
        "rows": rows[shard] + inside * np.array(counts)[shard],
        "partners": np.concatenate([part["partners"].reshape(-1, keypoints) for part in parts]),
    }
    found = [features for part in parts for features in _unpacked(part["keypoints"], keypoints)]
    tensors = {name: torch.from_numpy(values) for name, values in numbers.items()}
    return Examples(table_of(found, keypoints), **tensors)


def _unpacked(records: np.ndarray, keypoints: int) -> list[FeatureSet]:
    """As the map gives them back."""
    dtype = "uint8" if records["step"].dtype == np.uint8 else "float16"
    packing = Packing(keypoints, 2 * records["codes"].shape[-1], dtype, "euclidean")
    assert packing.record == records.dtype, "descriptors have an even number of numbers"
    return [packing.unpack(record) for record in records]
