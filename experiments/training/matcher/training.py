"""`topnav train matcher` from shards to weights."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import torch

from experiments.training.data.shards import shard_files
from experiments.training.detector.recipe import KeypointsRecipe
from experiments.training.detector.recipe import beginning as detector_beginning
from experiments.training.learning.checkpoints import SUFFIX, resume
from experiments.training.learning.running import RECIPE, require_same_shards
from experiments.training.learning.session import trained, written
from experiments.training.matcher.examples import Examples, read_examples
from experiments.training.matcher.recipe import MatcherRecipe, batch_loss, beginning
from experiments.training.panoramas.drawing import Pairs
from experiments.training.recipe import recipe_from
from experiments.training.sealed import sealed_files
from services.features.networks.runtime import device_named
from services.features.networks.spherical_keypoints import KeypointNet
from services.launcher.client.failure import ExperimentError

OWN = "own"
"""Instead of a pipeline's name: the keypoints of our own detector."""


def train(
    pairs: Path,
    into: Path,
    detector: Path,
    recipe: MatcherRecipe,
    device: str,
    until: int | None,
    export: Path | None,
    jobs: int,
) -> dict[str, Any]:
    """Train from the last checkpoint on.

    Raises:
        ExperimentError: no shards, a corrupted one, no detector, or a folder of another training.
        ValueError: no such device or pipeline.
    """
    where = device_named(device)
    files = shard_files(pairs)
    require_same_shards(files, into)
    examples = _read(files, pairs, detector, recipe, jobs).to(where)
    drawn = Pairs(examples, recipe.overlap, recipe.apart_m)
    network = beginning(recipe, examples.table.descriptors.shape[-1]).to(where)
    steps = trained(
        network,
        lambda net, rng: batch_loss(net, examples, drawn, recipe, rng),
        recipe.schedule,
        recipe,
        into,
        until,
    )
    figures = {"folder": str(into), "panoramas": len(examples), "pairs": len(drawn), "steps": steps}
    return figures | written(network, export, recipe, steps)


def _read(files: Sequence[Path], pairs: Path, detector: Path, recipe: MatcherRecipe, jobs: int) -> Examples:
    """Kept beside the shards: trainings of other sizes begin with them, too."""
    whose, network = recipe.features.replace("/", "-"), None
    if recipe.features == OWN:
        network = _trained_detector(detector)  # before hours of reading end there
        whose = sealed_files(detector, "step-*", SUFFIX)[-1].stem
    kept = pairs / f"keypoints-{whose}-{recipe.keypoints}"
    return read_examples(files, recipe.features, recipe.keypoints, network, kept, jobs)


def _trained_detector(folder: Path) -> KeypointNet:
    """As its last checkpoint has it."""
    file = folder / RECIPE
    network = detector_beginning(recipe_from(KeypointsRecipe, file)) if file.exists() else None
    if network is None or resume(folder, network, torch.optim.Adam(network.parameters())) == 0:
        raise ExperimentError(
            f"no checkpoint in {folder}: train one with 'topnav train keypoints --into {folder}'"
        )
    found: KeypointNet = network.network.eval()
    return found
