"""`topnav train keypoints`: data, loss and schedule in one place."""

import math

import numpy as np
import torch
from pydantic import NonNegativeFloat, PositiveFloat, PositiveInt
from torch import nn

from experiments.training.detector.losses import pair_losses
from experiments.training.learning.running import Schedule
from experiments.training.panoramas.drawing import Pairs
from experiments.training.panoramas.store import Panoramas
from experiments.training.recipe import Recipe
from services.features.networks.spherical_keypoints import KeypointNet, Shape, network_of


class KeypointsRecipe(Recipe):
    """How detector and descriptor are trained.

    Attributes:
        shape: of the network.
        batch: pairs of panoramas in a step.
        points: random points of a pair whose descriptors are compared.
        keypoints: drawn in each picture.
        overlap: least share of the directions that two panoramas of a pair both see.
        apart_m: most distance of the two.
        contrast: most factor, up or down, and exponent of the pictures' brightness (as a power of 2).
        noise: most sigma of what is added to each pixel, 0 to 1.
        temperature: factor of similarities at first.
        choice: weight of the choice within cells.
        schedule: how long and how fast.
    """

    shape: Shape = "slim"
    batch: PositiveInt = 8
    points: PositiveInt = 1024
    keypoints: PositiveInt = 1024
    overlap: PositiveFloat = 0.1
    apart_m: PositiveFloat = 6.0
    contrast: NonNegativeFloat = 0.6
    noise: NonNegativeFloat = 0.03
    temperature: PositiveFloat = 15.0
    choice: NonNegativeFloat = 0.5
    schedule: Schedule = Schedule(rate=2e-3)


class Trained(nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    """The network, and the factor of similarities that is learned beside it."""

    def __init__(self, recipe: KeypointsRecipe) -> None:
        super().__init__()
        self.network: KeypointNet = network_of(recipe.shape)
        self.log_temperature = nn.Parameter(torch.tensor(math.log(recipe.temperature)))


def beginning(recipe: KeypointsRecipe) -> Trained:
    """The network as it begins."""
    with torch.random.fork_rng(devices=()):  # torch draws first parameters from its global generator only
        torch.manual_seed(recipe.schedule.seed)
        return Trained(recipe)


def batch_loss(
    trained: Trained, panoramas: Panoramas, pairs: Pairs, recipe: KeypointsRecipe, rng: np.random.Generator
) -> torch.Tensor:
    """Loss of a batch of pairs drawn from `rng`."""
    device = panoramas.device
    chosen = torch.from_numpy(pairs.draw(recipe.batch, rng)).to(device)
    generator = torch.Generator(device).manual_seed(int(rng.integers(2**62)))
    shifts = torch.from_numpy(rng.integers(panoramas.strips.shape[-1], size=2 * recipe.batch)).to(device)
    grays = altered(panoramas.strips[chosen.T.reshape(-1)], shifts, recipe, rng, generator)
    with torch.autocast(device.type, torch.bfloat16, enabled=device.type == "cuda"):
        losses = pair_losses(
            trained.network,
            grays,
            shifts,
            chosen,
            panoramas,
            trained.log_temperature.exp().clamp(max=60.0),
            recipe.points,
            recipe.keypoints,
            generator,
        )
    return losses["points"] + losses["keypoints"] + losses["score"] + recipe.choice * losses["choice"]


def altered(
    strips: torch.Tensor,
    shifts: torch.Tensor,
    recipe: KeypointsRecipe,
    rng: np.random.Generator,
    generator: torch.Generator,
) -> torch.Tensor:
    """(B, 1, H, W) strips, 0 to 1: turned, lighter or darker, steeper or flatter, noisier."""
    batch, _, width = strips.shape
    columns = (torch.arange(width, device=strips.device)[None] - shifts[:, None]) % width
    turned = strips.gather(2, columns[:, None].expand_as(strips)).float() / 255.0
    power, factor = (
        torch.from_numpy(2.0 ** rng.uniform(-recipe.contrast, recipe.contrast, (batch, 1, 1))).float()
        for _ in range(2)
    )
    sigma = torch.from_numpy(recipe.noise * rng.random((batch, 1, 1))).float().to(strips.device)
    noise = torch.randn(turned.shape, generator=generator, device=strips.device) * sigma
    lit = turned.clamp(min=1e-4) ** power.to(strips.device) * factor.to(strips.device)
    return (lit + noise).clamp(0.0, 1.0)[:, None]
