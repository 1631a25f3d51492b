"""`topnav train residual` from shards to a checkpoint."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from experiments.training.data.shards import shard_files
from experiments.training.learning.running import require_same_shards
from experiments.training.learning.session import trained
from experiments.training.residual.recipe import ResidualRecipe, batch_loss, network_of
from experiments.training.residual.samples import samples_of
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError


def train(pairs: Path, into: Path, recipe: ResidualRecipe, until: int | None) -> dict[str, Any]:
    """Train from the last checkpoint on.

    Raises:
        ExperimentError: no shards, or a corrupted one, or a folder of another training.
    """
    pipeline = Pipeline(replace(find_profile("sift"), keypoints=recipe.keypoints))
    files = shard_files(pairs)
    require_same_shards(files, into)
    samples = samples_of(files, pipeline)
    if not samples:
        raise ExperimentError(f"no pair in {pairs} has enough common keypoints: draw more pairs")
    reached = trained(
        network_of(recipe),
        lambda network, rng: batch_loss(network, samples, recipe, rng),
        recipe.schedule,
        recipe,
        into,
        until,
    )
    return {"folder": str(into), "pairs": len(samples), "steps": reached}
