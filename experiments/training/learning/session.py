"""What the commands that train share: progress on the terminal, and the weights at the end."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from rich.progress import Progress

from experiments.training.learning.export import exported
from experiments.training.learning.running import Schedule, run
from experiments.training.recipe import Recipe
from services.launcher.terminal.output import wide_console


def trained(
    network: torch.nn.Module,
    loss_of: Callable[[Any, np.random.Generator], torch.Tensor],
    schedule: Schedule,
    recipe: Recipe,
    into: Path,
    until: int | None,
) -> int:
    """Train with a bar that moves; see `running.run`."""
    with Progress(console=wide_console(stderr=True), transient=True) as progress:
        task = progress.add_task("steps", total=schedule.steps)
        return run(
            network,
            loss_of,
            schedule,
            recipe,
            into,
            lambda step: progress.update(task, completed=step),
            until,
        )


def written(network: torch.nn.Module, path: Path | None, recipe: Recipe, steps: int) -> dict[str, Any]:
    """Figures of the file of weights; none where none is asked for."""
    if path is None:
        return {}
    size = exported(
        network, path, {"recipe": recipe.model_dump_json(), "steps": str(steps), "licence": "Apache-2.0"}
    )
    return {"weights": str(path), "bytes": size}
