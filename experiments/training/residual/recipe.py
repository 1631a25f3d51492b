"""`topnav train residual`: data, loss and schedule in one place."""

from collections.abc import Sequence

import numpy as np
import torch
from pydantic import Field, PositiveFloat, PositiveInt

from experiments.training.learning.running import Schedule
from experiments.training.recipe import Recipe
from experiments.training.residual.network import Residual
from experiments.training.residual.samples import Sample

FAR = 10.0
"""More than unit vectors are ever apart."""


class ResidualRecipe(Recipe):
    """How the residual on root SIFT is trained.

    Attributes:
        keypoints: per picture, as many as the pipeline takes.
        hidden: width of the network's inner layers.
        batch: pairs of pictures in a step.
        margin: of the triplet loss, between unit vectors (HardNet's).
        schedule: how long and how fast.
    """

    keypoints: PositiveInt = 300
    hidden: PositiveInt = 256
    batch: PositiveInt = 8
    margin: PositiveFloat = Field(default=1.0, le=2.0)
    schedule: Schedule = Schedule()


def network_of(recipe: ResidualRecipe) -> Residual:
    """The network as it begins."""
    with torch.random.fork_rng(devices=()):  # torch draws first parameters from its global generator only
        torch.manual_seed(recipe.schedule.seed)
        return Residual(recipe.hidden)


def batch_loss(
    network: torch.nn.Module, samples: Sequence[Sample], recipe: ResidualRecipe, rng: np.random.Generator
) -> torch.Tensor:
    """Mean triplet loss of a batch of pairs of pictures drawn from `rng`."""
    chosen = rng.choice(len(samples), min(recipe.batch, len(samples)), replace=False)
    return torch.cat([triplets(network, samples[k], recipe.margin) for k in chosen.tolist()]).mean()


def triplets(network: torch.nn.Module, sample: Sample, margin: float) -> torch.Tensor:
    """Loss (2K,) of the partners of one pair.

        max(0, margin + |a - b| - min |a - other|)    (Mishchuk et al. 2017), both ways

    The others are all keypoints of the other picture but those near the true place.
    """
    first, second = (
        network(torch.from_numpy(d), torch.from_numpy(c))
        for d, c in zip(sample.descriptors, sample.contexts, strict=True)
    )
    apart = torch.sqrt(torch.clamp(2.0 - 2.0 * first @ second.T, min=1e-6))
    rows, columns = (torch.from_numpy(sample.partners[:, k].astype(np.int64)) for k in (0, 1))
    near = torch.from_numpy(sample.near)
    others = torch.where(near, torch.full_like(apart, FAR), apart)
    right = apart[rows, columns]
    hardest = torch.cat([others.min(dim=1).values[rows], others.min(dim=0).values[columns]])
    return torch.relu(margin + torch.cat([right, right]) - hardest)
