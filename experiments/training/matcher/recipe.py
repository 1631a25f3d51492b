"""`topnav train matcher`: data, loss and schedule in one place."""

import numpy as np
import torch
from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt

from experiments.training.learning.running import Schedule
from experiments.training.matcher.features import FeatureTable
from experiments.training.matcher.losses import loss_of, truth_of
from experiments.training.panoramas.drawing import Pairs
from experiments.training.panoramas.store import Panoramas
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
    network: Attention,
    panoramas: Panoramas,
    table: FeatureTable,
    pairs: Pairs,
    recipe: MatcherRecipe,
    rng: np.random.Generator,
) -> torch.Tensor:
    """Loss of a batch of pairs drawn from `rng`."""
    device = panoramas.device
    chosen = torch.from_numpy(pairs.draw(recipe.batch, rng, recipe.others)).to(device)
    generator = torch.Generator(device).manual_seed(int(rng.integers(2**62)))
    kept = round(recipe.keypoints * float(np.linspace(recipe.fewest, 1.0, COUNTS)[rng.integers(COUNTS)]))
    one, other = (_thinned(table.of(side), kept, generator) for side in chosen.T)
    truth = truth_of(panoramas, chosen, one, other)
    with torch.autocast(device.type, torch.bfloat16, enabled=device.type == "cuda"):
        answers = network(
            _shaken(one, recipe.jitter_rad, generator), _shaken(other, recipe.jitter_rad, generator)
        )
    return loss_of(answers, truth, recipe.pair_weight)


def _thinned(points: Keypoints, kept: int, generator: torch.Generator) -> Keypoints:
    """So many keypoints of each picture, drawn."""
    assert points.present is not None
    luck = torch.rand(points.present.shape, generator=generator, device=points.present.device)
    rows = (luck + points.present).topk(min(kept, luck.shape[1]), dim=1).indices
    lonlat_rad, descriptors, context = (
        part.gather(1, rows[..., None].expand(-1, -1, part.shape[-1]))
        for part in (points.lonlat_rad, points.descriptors, points.context)
    )
    return Keypoints(lonlat_rad, descriptors, context, points.present.gather(1, rows))


def _shaken(points: Keypoints, sigma_rad: float, generator: torch.Generator) -> Keypoints:
    device = points.lonlat_rad.device
    noise = sigma_rad * torch.randn(points.lonlat_rad.shape, generator=generator, device=device)
    return Keypoints(points.lonlat_rad + noise, points.descriptors, points.context, points.present)
