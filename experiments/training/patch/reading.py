"""Patches of all shards, read side by side; the same whatever the number of processes."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from experiments.training.data.shards import trainable
from experiments.training.patch.samples import Patches, Sampling, joined, patches_of
from experiments.work.workers import workers

OVERLAPPING = 0.05
"""Share of the directions that both see, below which a pair shows different places."""


@dataclass(frozen=True)
class Reading:
    """What one process does.

    Attributes:
        path: of the shard.
        recipe: how patches are drawn.
        count: most of them.
    """

    path: str
    recipe: Sampling
    count: int


def read_patches(
    paths: Sequence[Path], recipe: Sampling, jobs: int = 1, tick: Callable[[], None] | None = None
) -> Patches:
    """Patches of all shards, evenly from each.

    Args:
        paths: of the shards.
        recipe: how patches are drawn.
        jobs: processes.
        tick: hears of every shard.

    Raises:
        ExperimentError: a shard is corrupted, or of a world by which training is judged.
    """
    count = max(1, recipe.most // len(paths))
    plans = [Reading(str(path), recipe, count) for path in paths]
    whole, end, panoramas = Patches.empty(count * len(plans)), 0, 0
    worlds: dict[str, int] = {}
    with ExitStack() as stack:
        pool = stack.enter_context(workers(jobs, None)) if jobs > 1 else None
        for name, pairs, part in _results(pool, plans):
            part.panoramas[:] += panoramas
            part.worlds[:] = worlds.setdefault(name, len(worlds))
            end, panoramas = whole.put(end, part), panoramas + pairs
            if tick is not None:
                tick()
    return whole[:end]


def read_one(plan: Reading) -> tuple[str, int, Patches]:
    """Patches of a shard.

    Returns:
        The name of its world, how many pairs of panoramas it has, and their patches.
    """
    shard = trainable(Path(plan.path))
    same = [pair for pair in shard.pairs if max(pair.overlap) >= OVERLAPPING]
    count = min(plan.recipe.per_pair, -(-plan.count // max(1, len(same))))
    parts = []
    for number, pair in enumerate(same):
        rng = np.random.default_rng([plan.recipe.seed, number, *Path(plan.path).name.encode()])
        part = patches_of(pair, plan.recipe, count, rng)
        part.panoramas[:] = number
        parts.append(part)
    return str(shard.world), len(same), joined(parts)[: plan.count]


def _results(pool: Executor | None, plans: Sequence[Reading]) -> Iterable[tuple[str, int, Patches]]:
    return map(read_one, plans) if pool is None else pool.map(_read_on_one_core, plans)


def _read_on_one_core(plan: Reading) -> tuple[str, int, Patches]:
    """Side by side, more threads only get in each other's way."""
    cv2.setNumThreads(1)
    return read_one(plan)
