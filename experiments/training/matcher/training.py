"""`topnav train matcher` from shards to weights."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from experiments.training.data.shards import shard_files
from experiments.training.detector.recipe import KeypointsRecipe
from experiments.training.detector.recipe import beginning as detector_beginning
from experiments.training.learning.checkpoints import resume
from experiments.training.learning.running import RECIPE, require_same_shards
from experiments.training.learning.session import trained, written
from experiments.training.matcher.features import FeatureTable, extracted, found_by
from experiments.training.matcher.recipe import MatcherRecipe, batch_loss, beginning
from experiments.training.panoramas.drawing import Pairs
from experiments.training.panoramas.store import Panoramas, load_panoramas
from experiments.training.recipe import recipe_from
from experiments.training.sealed import computed_once
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
    panoramas, table = _read(files, detector, recipe, where, jobs, into)
    drawn = Pairs(panoramas, recipe.overlap, recipe.apart_m)
    network = beginning(recipe, table.descriptors.shape[-1]).to(where)
    steps = trained(
        network,
        lambda net, rng: batch_loss(net, panoramas, table, drawn, recipe, rng),
        recipe.schedule,
        recipe,
        into,
        until,
    )
    figures = {"folder": str(into), "panoramas": len(panoramas), "pairs": len(drawn), "steps": steps}
    return figures | written(network, export, recipe, steps)


def _extracted(files: Sequence[Path], recipe: MatcherRecipe, jobs: int, kept: Path) -> FeatureTable:
    """Keypoints of a pipeline, kept beside the checkpoints: each piece of a training begins with them."""

    def make() -> dict[str, np.ndarray]:
        found = extracted(files, recipe.features, recipe.keypoints, jobs)
        return {name: part.numpy() for name, part in vars(found).items()}

    arrays = computed_once(kept, f"keypoints-{recipe.keypoints}", make)
    return FeatureTable(**{name: torch.from_numpy(part) for name, part in arrays.items()})


def _read(
    files: Sequence[Path], detector: Path, recipe: MatcherRecipe, where: torch.device, jobs: int, kept: Path
) -> tuple[Panoramas, FeatureTable]:
    if recipe.features == OWN:
        finder = _trained_detector(detector).to(where)  # before hours of reading end there
        panoramas = load_panoramas(files, where, jobs, kept)
        return panoramas, found_by(finder, panoramas, recipe.keypoints)
    table = _extracted(files, recipe, jobs, kept)
    return load_panoramas(files, where, jobs, kept), table.to(where)


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
