"""The way from shards to a trained descriptor of patches."""

from collections.abc import Sequence
from pathlib import Path

import torch
from rich.progress import Progress

from experiments.training.data.shards import about_shard
from experiments.training.learning.running import require_same_shards
from experiments.training.learning.session import trained
from experiments.training.patch.reading import read_patches
from experiments.training.patch.recipe import PatchRecipe, batch_loss, network_of
from experiments.training.patch.samples import Patches
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import wide_console

FEWEST = 2
"""Pairs of patches without which there is no wrong answer."""


def read(files: Sequence[Path], into: Path, recipe: PatchRecipe, jobs: int) -> Patches:
    """Patches of the shards.

    Args:
        files: the shards.
        into: folder of checkpoints, which belongs to them.
        recipe: how patches are drawn.
        jobs: processes that read.

    Raises:
        ExperimentError: a shard is corrupted or may not be trained on, the folder was begun with others, or
            hardly anything is seen twice.
    """
    require_same_shards(files, into)
    with Progress(console=wide_console(stderr=True), transient=True) as progress:
        task = progress.add_task("shards", total=len(files))
        patches = read_patches(files, recipe.sampling, jobs, lambda: progress.advance(task))
    if len(patches) < FEWEST:
        raise ExperimentError(f"hardly a corner is seen twice in {len(files)} shards: draw more pairs")
    return patches


def train(
    patches: Patches, recipe: PatchRecipe, into: Path, device: torch.device, until: int | None
) -> tuple[torch.nn.Module, int]:
    """Train on from the last checkpoint.

    Returns:
        The network, and the step that was reached.
    """
    network = network_of(recipe).to(device)
    reached = trained(
        network,
        lambda net, rng: batch_loss(net, patches, recipe, rng),
        recipe.schedule,
        recipe,
        into,
        until,
    )
    return network, reached


def about(recipe: PatchRecipe, steps: int, files: Sequence[Path]) -> dict[str, str]:
    """What exported weights say of themselves."""
    seeds = sorted({str(about_shard(path)["recipe"].get("seed")) for path in files})
    return {
        "name": f"topnav-{recipe.shape}",
        "licence": "Apache-2.0",
        "recipe": recipe.model_dump_json(),
        "steps": str(steps),
        "data_seed": ",".join(seeds),
    }
