"""`topnav train patch`: shape, data, loss and schedule in one place."""

import numpy as np
import torch
from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt

from experiments.training.learning.running import Schedule
from experiments.training.patch.batches import draw_batch
from experiments.training.patch.loss import hardest_in_batch, second_order
from experiments.training.patch.samples import Patches, Sampling
from experiments.training.recipe import Recipe
from services.features.networks.patch_shapes import Shape, network_named


class PatchRecipe(Recipe):
    """How a descriptor of patches is trained.

    Attributes:
        shape: of the network.
        batch: pairs of patches in a step.
        panoramas: pairs of panoramas that a batch is from: some sixteen patches of each, which must be told
            apart as in one picture.
        margin: of the triplet loss, between unit vectors (HardNet's).
        second_order: weight of second-order similarity; None for 1 with SOSNet, 0 with others, as published.
        neighbours: over so many on either side it is summed (SOSNet's).
        mirrored: share of pairs of which both patches are mirrored, as twice as many worlds would show them.
        sampling: how patches are drawn.
        schedule: how long and how fast.
    """

    shape: Shape = "hardnet"
    batch: PositiveInt = Field(default=1024, ge=2)
    panoramas: PositiveInt = 64
    margin: PositiveFloat = Field(default=1.0, le=2.0)
    second_order: NonNegativeFloat | None = None
    neighbours: PositiveInt = 8
    mirrored: float = Field(default=0.5, ge=0.0, le=1.0)
    sampling: Sampling = Sampling()
    schedule: Schedule = Schedule(steps=20_000, kept_every=500)

    @property
    def likeness(self) -> float:
        """Weight of second-order similarity."""
        return float(self.shape == "sosnet") if self.second_order is None else self.second_order


def network_of(recipe: PatchRecipe) -> torch.nn.Module:
    """The network as it begins, on the CPU."""
    torch.set_num_threads(recipe.schedule.threads)  # orthogonal matrices round otherwise with another number
    with torch.random.fork_rng(devices=()):  # torch draws first parameters from its global generator only
        torch.manual_seed(recipe.schedule.seed)
        return network_named(recipe.shape)


def batch_loss(
    network: torch.nn.Module, patches: Patches, recipe: PatchRecipe, rng: np.random.Generator
) -> torch.Tensor:
    """Mean loss of a batch drawn from `rng`, where the network is."""
    device = next(network.parameters()).device
    rows = draw_batch(patches, recipe.batch, recipe.panoramas, rng)
    pictures = patches.pictures[rows]
    mirrored = rng.random(len(rows)) < recipe.mirrored
    pictures[mirrored] = pictures[mirrored, ..., ::-1]
    first, second = _described(network, torch.from_numpy(pictures).to(device), int(rng.integers(2**31)))
    loss = hardest_in_batch(first, second, recipe.margin).mean()
    if recipe.likeness:
        loss = loss + recipe.likeness * second_order(first, second, recipe.neighbours).mean()
    return loss


def _described(
    network: torch.nn.Module, pictures: torch.Tensor, seed: int
) -> tuple[torch.Tensor, torch.Tensor]:
    """(N, 128) of each side of (N, 2, 32, 32) pictures, which pass together: with the same statistics."""
    on_gpu = pictures.device.type == "cuda"
    # Dropout draws from torch's global generators only.
    with torch.random.fork_rng(devices=[pictures.device] if on_gpu else ()):
        torch.manual_seed(seed)
        batch = pictures.transpose(0, 1).reshape(-1, 1, *pictures.shape[2:]).float() / 255.0
        with torch.autocast("cuda", torch.bfloat16, enabled=on_gpu):
            found = network(batch)
    first, second = found.chunk(2)
    return first, second
