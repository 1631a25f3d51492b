"""Weights that were trained here and come with topnav: no network is asked for them.

They are Apache-2.0 like the code; what each was trained on and what it is worth stands in deploy/TRAINING.md.
"""

import hashlib
import json
from typing import Any

import torch
from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

from services.features.networks.cache import path_of
from services.features.networks.catalogue import find_model
from services.features.networks.runtime import WeightsError


def own_weights(name: str) -> tuple[dict[str, torch.Tensor], dict[str, Any]]:
    """Parameters, in single precision, and the recipe they were trained by.

    Raises:
        WeightsError: there are none yet, the file is not there, or not the one that was given away.
    """
    from safetensors import SafetensorError, safe_open

    try:
        model, remedy = find_model(name), "install topnav again"
    except ValueError as error:
        raise WeightsError(f"no weights of {name} come with topnav yet: choose another pipeline") from error
    path = path_of(model)
    try:
        found = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise WeightsError(
            f"the weights of {name} cannot be read ({path}: {error.strerror}): {remedy}"
        ) from error
    if found != model.sha256:
        raise WeightsError(
            f"the weights of {name} are not those that come with topnav: {path} has the checksum "
            f"{found[:16]}, expected {model.sha256[:16]}: {remedy}"
        )
    try:
        with safe_open(path, framework="pt") as file:
            tensors = {key: file.get_tensor(key) for key in file.keys()}  # noqa: SIM118 - no mapping
            about = file.metadata() or {}
    except SafetensorError as error:
        raise WeightsError(f"the weights of {name} cannot be read ({path}: {error}): {remedy}") from error
    floats = {key: value.float() if value.is_floating_point() else value for key, value in tensors.items()}
    return floats, json.loads(about["recipe"])


def folded(network: nn.Module) -> nn.Module:
    """A network in evaluation mode without normalisations, which go into the convolutions before them.

    It is changed in place and says the same in less time.
    """
    for name, child in network.named_children():
        setattr(network, name, folded(child))
    if not isinstance(network, nn.Sequential):
        return network
    layers: list[nn.Module] = []
    for layer in network:
        if isinstance(layer, nn.BatchNorm2d) and layers and isinstance(layers[-1], nn.Conv2d):
            layers[-1] = fuse_conv_bn_eval(layers[-1], layer)
        else:
            layers.append(layer)
    return nn.Sequential(*layers)
