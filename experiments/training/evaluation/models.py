"""What is compared: pipelines that are there, and a checkpoint of ours on top of SIFT."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import torch

from experiments.training.learning.checkpoints import SUFFIX, resume
from experiments.training.learning.running import RECIPE
from experiments.training.recipe import recipe_from
from experiments.training.residual.recipe import ResidualRecipe, network_of
from experiments.training.sealed import sealed_files
from experiments.training.sights import Image
from services.features.networks.attention import context_of
from services.features.networks.catalogue import MODELS
from services.features.networks.loaders import PARTS
from services.features.networks.runtime import WeightsError, unit_descriptors
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import FeatureSet, Profile
from services.features.pipeline.named_pipelines import ATTENTION, find_profile
from services.features.pipeline.pipeline import Pipeline
from services.features.pipeline.plugins import OWN_MATCHERS
from services.launcher.client.failure import ExperimentError

OURS = "residual"


@dataclass(frozen=True, eq=False)
class Model:
    """One row of the table.

    Attributes:
        name: of it.
        size_bytes: of its weights, as far as the catalogue knows; 0 without any.
        pipeline: whose matcher and verification answer.
        features: of a panorama.
    """

    name: str
    size_bytes: int
    pipeline: Pipeline
    features: Callable[[Image], FeatureSet]


def available(names: Sequence[str]) -> tuple[list[Model], dict[str, str]]:
    """Pipelines by name.

    Returns:
        Those that can be had, and why the others cannot: their weights are not here.

    Raises:
        ValueError: no such pipeline.
    """
    models, absent = [], {}
    for name in names:
        try:
            pipeline = Pipeline(find_profile(name))
        except WeightsError as error:
            absent[name] = str(error)
        else:
            features = partial(_extracted, pipeline=pipeline)
            models.append(Model(name, _weights_bytes(pipeline.profile), pipeline, features))
    return models, absent


def trained_residual(folder: Path) -> Model:
    """The newest checkpoint of `topnav train residual`.

    Raises:
        ExperimentError: there is none, or it is corrupted.
    """
    files = sealed_files(folder, "step-*", SUFFIX)
    if not files:
        raise ExperimentError(
            f"no checkpoint in {folder}: train one with 'topnav train residual --into {folder}'"
        )
    recipe = recipe_from(ResidualRecipe, folder / RECIPE)
    network = network_of(recipe)
    resume(folder, network, torch.optim.Adam(network.parameters()))
    pipeline = Pipeline(replace(find_profile("sift"), keypoints=recipe.keypoints))

    def features(picture: Image) -> FeatureSet:
        found = _extracted(picture, pipeline)
        with torch.inference_mode():
            raw = torch.from_numpy(found.descriptors.astype(np.float32))
            new = network(raw, torch.from_numpy(context_of(found)))
        return replace(found, descriptors=unit_descriptors(new))

    size = sum(4 * value.numel() for value in network.state_dict().values())
    return Model(OURS, size, pipeline, features)


def _weights_bytes(profile: Profile) -> int:
    own = ATTENTION.get(profile.extractor) if profile.matcher in OWN_MATCHERS else None
    plugins = {profile.extractor, profile.matcher} - {*OWN_MATCHERS}
    return sum(
        model.size_bytes
        for model in MODELS
        if model.name == own or (plugins & {*model.pipelines} and model.name not in PARTS)
    )


def _extracted(picture: Image, pipeline: Pipeline) -> FeatureSet:
    return extract(picture, pipeline.extractor, pipeline.representation, pipeline.profile)
