"""What a training is at a step: parameters and the optimiser's moments in one sealed file of safetensors."""

from pathlib import Path

import torch
from safetensors.torch import load, save

from experiments.training.sealed import read_sealed, sealed_files, write_sealed
from services.launcher.client.failure import ExperimentError

SUFFIX = ".safetensors"
REMEDY = "delete it to begin from the one before, or anew where there is none"


def keep(folder: Path, step: int, network: torch.nn.Module, optimiser: torch.optim.Optimizer) -> Path:
    """Write the checkpoint of a step; the one before stays, in case this one breaks."""
    tensors = {f"network.{name}": value.cpu().contiguous() for name, value in network.state_dict().items()}
    for number, moments in optimiser.state_dict()["state"].items():
        tensors |= {f"optimiser.{number}.{name}": value.cpu().contiguous() for name, value in moments.items()}
    path = write_sealed(folder, f"step-{step:08d}", SUFFIX, save(tensors))
    for older in sealed_files(folder, "step-*", SUFFIX)[:-2]:
        older.unlink()
    return path


def resume(folder: Path, network: torch.nn.Module, optimiser: torch.optim.Optimizer) -> int:
    """Put back the newest checkpoint.

    Returns:
        Its step; 0 where there is none.

    Raises:
        ExperimentError: it is corrupted, or of another network.
    """
    files = sealed_files(folder, "step-*", SUFFIX)
    if not files:
        return 0
    tensors = load(read_sealed(files[-1], "checkpoint", REMEDY))
    own = {name.partition(".")[2]: value for name, value in tensors.items() if name.startswith("network.")}
    moments: dict[int, dict[str, torch.Tensor]] = {}
    for name, value in tensors.items():
        kind, number, what = [*name.split(".", 2), ""][:3]
        if kind == "optimiser":
            moments.setdefault(int(number), {})[what] = value
    try:
        network.load_state_dict(own)
    except RuntimeError as error:
        raise ExperimentError(
            f"checkpoint {files[-1]} is of another network: choose another folder"
        ) from error
    optimiser.load_state_dict({**optimiser.state_dict(), "state": moments})
    return int(files[-1].name.split("-")[1])
