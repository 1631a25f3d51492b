"""Where networks run and how their weights are loaded."""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import numpy.typing as npt
import torch

from services.features.pipeline.interfaces import Image


class WeightsError(RuntimeError):
    """Trained weights are neither in the cache nor to be had."""


def device_named(name: str) -> torch.device:
    """The device of this name.

    Raises:
        ValueError: 'cuda' is asked for where there is none.
    """
    if name == "cuda" and not torch.cuda.is_available():
        raise ValueError("device cuda is asked for, but torch sees no GPU: use device cpu")
    return torch.device(name)


@contextmanager
def loading(what: str) -> Iterator[None]:
    """Turn whatever a library raises while it loads weights into one line that says what to do."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", UserWarning
            )  # kornia tells every retry; one line at the end will do
            yield
    except (OSError, RuntimeError, ValueError) as error:
        first = str(error).strip().splitlines()[0][:200] if str(error).strip() else type(error).__name__
        raise WeightsError(
            f"the weights of {what} could not be loaded ({first}): run 'topnav models pull {what}' where "
            "there is a network, or copy the file into the cache that 'topnav models list' names"
        ) from error


def unit_descriptors(found: torch.Tensor) -> npt.NDArray[np.float16]:
    """Descriptors (N, D) of length one, as they travel."""
    lengths = torch.linalg.vector_norm(found.float(), dim=-1, keepdim=True).clamp_min(1e-6)
    return np.asarray((found.float() / lengths).cpu().numpy(), np.float16)


def batch_of(grays: Sequence[Image], channels: int, device: torch.device) -> torch.Tensor:
    """Grey pictures of one size as a batch (B, channels, H, W), 0 to 1."""
    stacked = torch.from_numpy(np.stack(grays)).to(device)
    return (stacked.float() / 255.0)[:, None].expand(-1, channels, -1, -1)
