"""What the matcher learns from two panoramas whose geometry is known: LightGlue's loss, at every layer."""

from dataclasses import dataclass

import torch
from torch.nn import functional

from experiments.training.correspondences import RIGHT_RAD
from experiments.training.panoramas.store import Panoramas, bearings
from services.features.networks.attention import Assignment, Keypoints

APART_RAD = 2.0 * RIGHT_RAD
"""A keypoint without another this near to its place has no partner; between the two nobody knows."""
SAME = 0.05
"""Overlap from which two panoramas show the same place, as in evaluation."""


@dataclass(frozen=True, eq=False)
class Truth:
    """What is right for a batch of P pairs.

    Attributes:
        partners: (P, N, M) the same point, each keypoint at most once.
        alone: two of (P, N) and (P, M), keypoints without a partner.
        overlap: (P,) the smaller share of the directions that the other sees.
        log_distance: (P,) logarithm of the metres between them.
    """

    partners: torch.Tensor
    alone: tuple[torch.Tensor, torch.Tensor]
    overlap: torch.Tensor
    log_distance: torch.Tensor


def truth_of(panoramas: Panoramas, pairs: torch.Tensor, one: Keypoints, other: Keypoints) -> Truth:
    """Of the pairs (P, 2) and the keypoints of both sides."""
    here, there = pairs.T
    assert one.present is not None, "a table says which are there"
    assert other.present is not None, "a table says which are there"
    off, visible, known = _off(panoramas, here, there, one, other)
    off_back, visible_back, known_back = _off(panoramas, there, here, other, one)
    both = torch.maximum(off, off_back.transpose(1, 2))
    seen = visible[:, :, None] & visible_back[:, None, :]
    near = torch.where(seen, both, torch.inf)
    first, second = near.argmin(1)[:, None, :], near.argmin(2)[:, :, None]  # of equal ones the first
    rows, columns = (torch.arange(size, device=near.device) for size in near.shape[1:])
    mutual = (first == rows[:, None]) & (second == columns)
    same = panoramas.shard[here] == panoramas.shard[there]
    partners = mutual & (near <= RIGHT_RAD) & same[:, None, None]
    elsewhere = ~same[:, None]
    alone = (
        one.present & (elsewhere | (known & (~visible | (off.amin(2) > APART_RAD)))),
        other.present & (elsewhere | (known_back & (~visible_back | (off_back.amin(2) > APART_RAD)))),
    )
    overlap = torch.minimum(panoramas.overlap[here, there], panoramas.overlap[there, here]).float()
    distance = (panoramas.positions_m[here] - panoramas.positions_m[there]).norm(dim=-1)
    return Truth(partners, alone, overlap, distance.clamp(min=0.1).log())


def loss_of(answers: list[Assignment], truth: Truth, pair_weight: float) -> torch.Tensor:
    """Mean over layers: partners found, those alone known to be alone, and what is said of the pair."""
    total = torch.zeros((), device=truth.overlap.device)
    for answer in answers:
        found = _by_pair(-answer.log_right, truth.partners)
        alone = sum(
            _by_pair(functional.softplus(logit), lone)
            for logit, lone in zip(answer.matchable, truth.alone, strict=True)
        )
        total = total + found + 0.5 * alone + pair_weight * _pair_loss(answer.pair, truth)
    return total / len(answers)


def _pair_loss(said: torch.Tensor, truth: Truth) -> torch.Tensor:
    same = (truth.overlap >= SAME).float()
    place = functional.binary_cross_entropy_with_logits(said[:, 0], same)
    overlap = (said[:, 1].sigmoid() - truth.overlap).abs().mean()
    distance = ((said[:, 2] - truth.log_distance).abs() * same).sum() / same.sum().clamp(min=1.0)
    return place + overlap + distance


def _by_pair(values: torch.Tensor, where: torch.Tensor) -> torch.Tensor:
    """Mean over pairs of pictures of the mean within each; those without any count nothing."""
    rows = torch.where(where, values, 0.0).flatten(1).sum(1)
    counts = where.flatten(1).sum(1)
    return (rows / counts.clamp(min=1)).sum() / (counts > 0).sum().clamp(min=1)


def _off(
    panoramas: Panoramas, here: torch.Tensor, there: torch.Tensor, one: Keypoints, other: Keypoints
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """(P, N, M) angle between where a keypoint here is there and those there; (P, N) seen, and known."""
    seen, visible, known = panoramas.seen_from(one.lonlat_rad, here, there)
    cosine = seen @ bearings(other.lonlat_rad).transpose(1, 2)
    assert one.present is not None
    assert other.present is not None
    off = torch.acos(cosine.clamp(-1.0, 1.0)).masked_fill(~other.present[:, None, :], torch.inf)
    return off, visible & one.present, known
