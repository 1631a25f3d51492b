"""What of the trained weights is on this machine, and whether it is what it should be."""

import hashlib
import os
from pathlib import Path
from typing import Literal

from services.features.networks.catalogue import TrainedModel

State = Literal["absent", "verified", "unpinned", "broken"]

OWN_FOLDER = Path(__file__).resolve().parents[1] / "weights"
"""Of what was trained here and comes with the code."""


def cache_folder() -> Path:
    """Where kornia keeps its files: $TORCH_HOME/hub/checkpoints."""
    home = os.environ.get("TORCH_HOME") or Path.home() / ".cache" / "torch"
    return Path(home) / "hub" / "checkpoints"


def hub_folder() -> Path:
    """Where transformers keeps its repositories."""
    home = os.environ.get("HF_HOME") or Path.home() / ".cache" / "huggingface"
    return Path(home) / "hub"


def path_of(model: TrainedModel) -> Path:
    """File or folder of a model, whether or not it is there."""
    if model.source == "transformers":
        return hub_folder() / f"models--{model.file.replace('/', '--')}"
    if model.source == "topnav":
        return OWN_FOLDER / model.file
    return cache_folder() / model.file


def state_of(model: TrainedModel) -> State:
    """Read and check a model; 'unpinned' is there without a checksum to hold it against."""
    path = path_of(model)
    if not path.exists():
        return "absent"
    if not model.sha256:
        return "unpinned"
    with path.open("rb") as file:
        found = hashlib.file_digest(file, "sha256").hexdigest()
    return "verified" if found == model.sha256 else "broken"
