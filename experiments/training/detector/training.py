"""`topnav train keypoints` from shards to weights."""

from pathlib import Path
from typing import Any

from experiments.training.data.shards import shard_files
from experiments.training.detector.recipe import KeypointsRecipe, batch_loss, beginning
from experiments.training.learning.running import require_same_shards
from experiments.training.learning.session import trained, written
from experiments.training.panoramas.drawing import Pairs
from experiments.training.panoramas.store import load_panoramas
from services.features.networks.runtime import device_named


def train(
    pairs: Path,
    into: Path,
    recipe: KeypointsRecipe,
    device: str,
    until: int | None,
    export: Path | None,
    jobs: int,
) -> dict[str, Any]:
    """Train from the last checkpoint on.

    Raises:
        ExperimentError: no shards, or a corrupted one, or a folder of another training.
        ValueError: no such device.
    """
    where = device_named(device)
    files = shard_files(pairs)
    require_same_shards(files, into)
    panoramas = load_panoramas(files, where, jobs, into)
    drawn = Pairs(panoramas, recipe.overlap, recipe.apart_m)
    network = beginning(recipe).to(where)
    steps = trained(
        network,
        lambda net, rng: batch_loss(net, panoramas, drawn, recipe, rng),
        recipe.schedule,
        recipe,
        into,
        until,
    )
    figures = {"folder": str(into), "panoramas": len(panoramas), "pairs": len(drawn), "steps": steps}
    return figures | written(network.network, export, recipe, steps)
