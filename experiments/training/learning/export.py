"""Trained weights alone, as they come with topnav: safetensors in half precision, with what they are."""

from collections.abc import Mapping
from pathlib import Path

import torch
from safetensors.torch import save_file

from services.launcher.client.failure import ExperimentError

MOST_BYTES = 4_000_000
"""Of a file that is to come with topnav."""


def export(network: torch.nn.Module, path: Path, about: Mapping[str, str]) -> int:
    """Write a network's parameters and buffers.

    Args:
        network: whose state is written.
        path: of the file.
        about: recipe, data and steps, kept in the file's header.

    Returns:
        Its size in bytes.

    Raises:
        ExperimentError: it would be too large to come with topnav.
    """
    halves = {
        name: (value.half() if value.is_floating_point() else value).detach().cpu().contiguous()
        for name, value in network.state_dict().items()
    }
    size = sum(value.numel() * value.element_size() for value in halves.values())
    if size > MOST_BYTES:
        raise ExperimentError(f"weights of {size} bytes are too large for {path}: at most {MOST_BYTES}")
    path.parent.mkdir(parents=True, exist_ok=True)
    save_file(halves, path, metadata={**about, "licence": "Apache-2.0"})
    return path.stat().st_size
