"""The loop of every recipe. Step k draws from a generator of (seed, k), wherever it was cut off."""

import json
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import torch
from pydantic import NonNegativeInt, PositiveFloat, PositiveInt

from experiments.training.learning.checkpoints import keep, resume
from experiments.training.recipe import Recipe
from services.launcher.client.failure import ExperimentError

LossOf = Callable[[torch.nn.Module, np.random.Generator], torch.Tensor]
RECIPE, SHARDS, LOG = "recipe.json", "shards.txt", "log.jsonl"


class Schedule(Recipe):
    """How long and how fast.

    Attributes:
        seed: of the network's first parameters and of every batch.
        steps: batches in all.
        rate: of Adam at first; it falls to 0 along half a cosine.
        warmup: steps in which the rate rises to that.
        clip: most norm of all gradients together; None: whatever they are.
        kept_every: steps between checkpoints and lines of the log.
        threads: cores; another number may round otherwise. Every step waits for the slowest of
            them, which others may use, too.
    """

    seed: NonNegativeInt = 1
    steps: PositiveInt = 2000
    rate: PositiveFloat = 1e-3
    warmup: NonNegativeInt = 0
    clip: PositiveFloat | None = None
    kept_every: PositiveInt = 100
    threads: PositiveInt = 1

    def rate_at(self, step: int) -> float:
        """Adam's rate for the batch after so many steps."""
        rising = min(1.0, (step + 1) / (self.warmup + 1))
        return rising * 0.5 * self.rate * (1.0 + math.cos(math.pi * step / self.steps))


def run(
    network: torch.nn.Module,
    loss_of: LossOf,
    schedule: Schedule,
    recipe: Recipe,
    folder: Path,
    tick: Callable[[int], None] | None = None,
    until: int | None = None,
) -> int:
    """Train from the last checkpoint on, to `until` or the end.

    Args:
        network: as it begins; changed in place.
        loss_of: a step's loss, its batch drawn from the generator it gets.
        schedule: how long.
        recipe: everything but the data that the result depends on; a folder belongs to one.
        folder: of checkpoints and log.
        tick: hears of every step.
        until: stop early after this step, with a checkpoint.

    Returns:
        The step that was reached.

    Raises:
        ExperimentError: the folder is of another recipe, or its checkpoint is corrupted.
    """
    _require_same(folder / RECIPE, recipe.model_dump_json(indent=2) + "\n", "another recipe")
    torch.set_num_threads(schedule.threads)
    optimiser = torch.optim.Adam(network.parameters(), lr=schedule.rate)
    step, began = resume(folder, network, optimiser), time.monotonic()
    last = min(schedule.steps, until if until is not None else schedule.steps)
    losses: list[torch.Tensor] = []
    while step < last:
        for group in optimiser.param_groups:
            group["lr"] = schedule.rate_at(step)
        optimiser.zero_grad()
        loss = loss_of(network, np.random.default_rng([schedule.seed, step]))
        loss.backward()
        if schedule.clip is not None:
            torch.nn.utils.clip_grad_norm_(network.parameters(), schedule.clip)
        optimiser.step()
        losses.append(loss.detach())
        step += 1
        if tick is not None:
            tick(step)
        if step % schedule.kept_every == 0 or step == last:
            keep(folder, step, network, optimiser)
            line = {
                "step": step,
                "loss": round(float(torch.stack(losses).mean()), 6),
                "time_s": round(time.monotonic() - began, 1),
            }
            with (folder / LOG).open("a", encoding="utf-8") as log:
                log.write(json.dumps(line) + "\n")
            losses.clear()
    return step


def require_same_shards(shards: Sequence[Path], folder: Path) -> None:
    """A folder of checkpoints belongs to the shards it was begun with, whose names tell their contents.

    Raises:
        ExperimentError: it was begun with others.
    """
    _require_same(folder / SHARDS, "".join(f"{path.name}\n" for path in shards), "other pairs")


def _require_same(path: Path, text: str, other: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists():
        path.write_text(text, encoding="utf-8")
    elif path.read_text(encoding="utf-8") != text:
        raise ExperimentError(f"{path} tells of {other} than asked for: choose another folder")
