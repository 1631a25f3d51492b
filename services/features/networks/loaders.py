"""Loads every trained model once, through the library that owns it: which also downloads it."""

from collections.abc import Callable

import kornia.feature as kf

from services.features.networks.catalogue import TrainedModel
from services.features.networks.own_weights import own_weights
from services.features.pipeline.interfaces import Profile, Runtime
from services.features.pipeline.plugins import create_extractor, create_matcher

LIGHTGLUE_EXTRACTORS = {
    "lightglue-aliked": "aliked-n16",
    "lightglue-disk": "disk",
    "lightglue-xfeat": "xfeat",
    "lightglue-dedode": "dedode",
}
PARTS: dict[str, Callable[[], object]] = {
    "affnet": lambda: kf.LAFAffNetShapeEstimator(pretrained=True),
    "orinet": lambda: kf.OriNet(pretrained=True),
    "keynet": lambda: kf.KeyNetDetector(pretrained=True),
}


def load(model: TrainedModel) -> None:
    """Load a model into memory, downloading it where it is missing.

    Raises:
        WeightsError: it is not to be had.
        ValueError: its licence needs consent.
    """
    if model.source == "topnav":
        own_weights(model.name)
    elif model.name in PARTS:
        PARTS[model.name]()
    elif model.name in LIGHTGLUE_EXTRACTORS:
        profile = Profile(LIGHTGLUE_EXTRACTORS[model.name], matcher="lightglue")
        create_matcher(profile, "euclidean", Runtime())
    elif model.name.startswith("superglue"):
        matcher = "superglue-outdoor" if model.name.endswith("outdoor") else "superglue"
        create_matcher(Profile("superpoint", matcher=matcher), "euclidean", Runtime())
    else:
        create_extractor(Profile(model.pipelines[0]), Runtime())
