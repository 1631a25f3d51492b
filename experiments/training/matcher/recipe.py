"""`topnav train matcher`: data, loss and schedule in one place."""

import numpy as np
import torch
from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt

from experiments.training.learning.running import Schedule
from experiments.training.matcher.examples import Examples
from experiments.training.matcher.losses import loss_of
from experiments.training.panoramas.drawing import Pairs
from experiments.training.recipe import Recipe
from services.features.networks.attention import Attention, Keypoints

COUNTS = 6
"""Numbers of keypoints that are met: each is another size of all tensors, which costs time on a GPU."""


class MatcherRecipe(Recipe):
    """How the matcher is trained.

    Attributes:
        features: pipeline whose keypoints it matches, or `own` for a checkpoint of `topnav train keypoints`.
        keypoints: of a picture, at most.
        width: numbers of a keypoint within the network; `heads` of attention; `layers` of it.
        batch: pairs of panoramas in a step.
        fewest: least share of the keypoints that a step leaves, so that other numbers are met too.
        others: share of pairs that show perhaps nothing in common.
        overlap: least share of the directions that the two of any other pair both see.
        apart_m: most distance of those.
        jitter_rad: 1 sigma of what is added to bearings.
        pair_weight: of what is said of the pair as a whole.
        schedule: how long and how fast.
    """

    features: str = "sift"
    keypoints: PositiveInt = 300
    width: PositiveInt = 64
    heads: PositiveInt = 2
    layers: PositiveInt = 3
    batch: PositiveInt = 32
    fewest: float = Field(default=0.5, gt=0.0, le=1.0)
    others: float = Field(default=0.25, ge=0.0, le=1.0)
    overlap: PositiveFloat = 0.05
    apart_m: PositiveFloat = 8.0
    jitter_rad: NonNegativeFloat = 0.001
    pair_weight: NonNegativeFloat = 0.3
    schedule: Schedule = Schedule(rate=1e-3, warmup=300, clip=1.0)


def beginning(recipe: MatcherRecipe, dimension: int) -> Attention:
    """The network as it begins, for descriptors of so many numbers."""
    with torch.random.fork_rng(devices=()):  # torch draws first parameters from its global generator only
        torch.manual_seed(recipe.schedule.seed)
        return Attention(dimension, recipe.width, recipe.heads, recipe.layers)


def batch_loss(
    network: Attention, examples: Examples, pairs: Pairs, recipe: MatcherRecipe, rng: np.random.Generator
) -> torch.Tensor:
    """Loss of a batch of pairs drawn from `rng`."""
    device = examples.device
    chosen = torch.from_numpy(pairs.draw(recipe.batch, rng, recipe.others)).to(device)
    generator = torch.Generator(device).manual_seed(int(rng.integers(2**62)))
    count = round(recipe.keypoints * float(np.linspace(recipe.fewest, 1.0, COUNTS)[rng.integers(COUNTS)]))
    both = [examples.table.of(side) for side in chosen.T]
    kept = [_drawn(points, count, generator) for points in both]
    one, other = (
        _shaken(_thinned(points, rows), recipe.jitter_rad, generator)
        for points, rows in zip(both, kept, strict=True)
    )
    truth = examples.truth(chosen, *kept)
    with torch.autocast(device.type, torch.bfloat16, enabled=device.type == "cuda"):
        answers = network(one, other)
    return loss_of(answers, truth, recipe.pair_weight)


def _drawn(points: Keypoints, count: int, generator: torch.Generator) -> torch.Tensor:
    """(B, n) numbers of so many keypoints of each picture, those that are missing last."""
    assert points.present is not None
    luck = torch.rand(points.present.shape, generator=generator, device=points.present.device)
    return (luck + points.present).topk(min(count, luck.shape[1]), dim=1).indices


def _thinned(points: Keypoints, rows: torch.Tensor) -> Keypoints:
    assert points.present is not None
    lonlat_rad, descriptors, context = (
        part.gather(1, rows[..., None].expand(-1, -1, part.shape[-1]))
        for part in (points.lonlat_rad, points.descriptors, points.context)
    )
    return Keypoints(lonlat_rad, descriptors, context, points.present.gather(1, rows))


def _shaken(points: Keypoints, sigma_rad: float, generator: torch.Generator) -> Keypoints:
    device = points.lonlat_rad.device
    noise = sigma_rad * torch.randn(points.lonlat_rad.shape, generator=generator, device=device)
    return Keypoints(points.lonlat_rad + noise, points.descriptors, points.context, points.present)
