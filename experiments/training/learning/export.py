"""What is given away of a training: the network alone, in half precision, with where it is from."""

from collections.abc import Mapping
from pathlib import Path

import torch
from safetensors.torch import save

from services.launcher.client.failure import ExperimentError

MOST_BYTES = 4_000_000
"""Chosen: weights travel in the repository."""


def exported(network: torch.nn.Module, path: Path, about: Mapping[str, str]) -> int:
    """Write the parameters and statistics of a network as float16 in one file of safetensors.

    Args:
        network: any; what it counts stays whole numbers.
        path: of the file.
        about: name, recipe, steps, seeds, licence: what the file says of itself.

    Returns:
        Size of the file, bytes.

    Raises:
        ExperimentError: a value is beyond what float16 holds, or the file is too large to be given away.
    """
    tensors = {name: _halved(name, value) for name, value in network.state_dict().items()}
    data = save(tensors, dict(about))
    if len(data) > MOST_BYTES:
        raise ExperimentError(
            f"the weights take {len(data)} bytes, at most {MOST_BYTES} are given away: choose a smaller shape"
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    new.write_bytes(data)
    new.replace(path)
    return len(data)


def _halved(name: str, value: torch.Tensor) -> torch.Tensor:
    value = value.detach().cpu().contiguous()
    if not value.is_floating_point():
        return value
    half = value.half()
    if not bool(torch.isfinite(half).all()):
        raise ExperimentError(f"{name} does not fit into half precision: training has diverged")
    return half
