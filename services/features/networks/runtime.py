"""Where networks run, how their weights are loaded, and which of them need consent."""

import os
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import numpy.typing as npt
import torch

from services.features.networks.cache import path_of
from services.features.networks.catalogue import find_model
from services.features.pipeline.interfaces import Image
from shared.geometry.sphere import EquirectGrid

WIDTH_PX, HEIGHT_PX = 800, 400
"""Flat picture in which learned matchers see keypoints: the thesis's size (appendix A)."""

NON_COMMERCIAL = "TOPNAV_NON_COMMERCIAL"
"""Variable by which somebody says that the use is not commercial."""
DOWNLOAD = "TOPNAV_DOWNLOAD_WEIGHTS"
"""Variable by which somebody asks for weights that are missing; `topnav models pull` sets it."""


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


def quick_products(device: torch.device) -> torch.autocast:
    """Matrices are multiplied in bfloat16 where a CPU has units for that (AMX), and as they are elsewhere."""
    has_units = device.type == "cpu" and torch.cpu.get_capabilities().get("amx_bf16", False)
    return torch.autocast(device.type, torch.bfloat16, enabled=has_units)


@contextmanager
def loading(what: str, *, trained: bool = True) -> Iterator[None]:
    """Turn whatever a library raises while it loads weights into one line that says what to do.

    Libraries download what is missing. That is for those who ask for it: without network it takes minutes.
    """
    try:
        if trained and not path_of(find_model(what)).exists() and not _is_set(DOWNLOAD):
            raise FileNotFoundError("they are not here")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # kornia tells every retry; one line will do
            yield
    except (OSError, RuntimeError, ValueError) as error:
        first = str(error).strip().splitlines()[0][:200] if str(error).strip() else type(error).__name__
        raise WeightsError(
            f"the weights of {what} could not be loaded ({first}): run 'topnav models pull {what}' where "
            "there is a network, or copy the file into the cache that 'topnav models list' names"
        ) from error


def _is_set(variable: str) -> bool:
    return os.environ.get(variable, "").lower() in ("1", "true", "yes")


def require_consent(model: str) -> None:
    """Refuse weights whose licence forbids commercial use unless the environment says that this is none.

    Raises:
        ValueError: it does not; the text names the licence and the variable.
    """
    if not _is_set(NON_COMMERCIAL):
        raise ValueError(
            f"the weights of {model} are licensed by Magic Leap for non-commercial research only: "
            f"set {NON_COMMERCIAL}=1 if that is your use, or choose another pipeline, for example aliked-n16"
        )


def unit_descriptors(found: torch.Tensor) -> npt.NDArray[np.float16]:
    """Descriptors (N, D) of length one, as they travel."""
    lengths = torch.linalg.vector_norm(found.float(), dim=-1, keepdim=True).clamp_min(1e-6)
    return np.asarray((found.float() / lengths).cpu().numpy(), np.float16)


def batch_of(grays: Sequence[Image], channels: int, device: torch.device) -> torch.Tensor:
    """Grey pictures of one size as a batch (B, channels, H, W), 0 to 1."""
    stacked = torch.from_numpy(np.stack(grays)).to(device)
    return (stacked.float() / 255.0)[:, None].expand(-1, channels, -1, -1)


def pixels_of(lonlat_rad: npt.NDArray[np.float32], device: torch.device) -> torch.Tensor:
    """Equirectangular pixels (1, N, 2), x from 0 to WIDTH_PX, of longitudes and latitudes (N, 2)."""
    pixels = EquirectGrid(WIDTH_PX, HEIGHT_PX).pixels_from_lonlat(lonlat_rad)
    return torch.as_tensor(pixels[None], dtype=torch.float32, device=device)
