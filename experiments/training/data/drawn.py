"""All shards of a folder, side by side; what an earlier run finished is kept."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import as_completed
from pathlib import Path
from typing import Any

from rich.progress import Progress

from experiments.training.data.making import ShardPlan, make_shard
from experiments.training.data.recipe import DataRecipe
from experiments.training.data.shards import about_shard
from experiments.training.worlds import WorldName
from experiments.work.workers import workers
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import wide_console
from simulator.generation.splits import Split


def plan_shards(
    worlds: Sequence[WorldName], split: Split, shards: int, pairs: int, recipe: DataRecipe, folder: Path
) -> list[ShardPlan]:
    """So many shards of each world, all first ones first: data cut off early is of many worlds."""
    return [
        ShardPlan(world, split, number, pairs, recipe, str(folder))
        for number in range(shards)
        for world in worlds
    ]


def make_missing(
    plans: Sequence[ShardPlan], jobs: int, make: Callable[[ShardPlan], int] = make_shard
) -> list[ShardPlan]:
    """Make the shards that are not there.

    Returns:
        The plans of those that were made.

    Raises:
        ExperimentError: a shard that is there is corrupted, or of another recipe or length.
    """
    missing = [plan for plan in plans if plan.done is None]
    for plan in plans:
        if plan.done is not None:
            _require_same(plan, plan.done)
    if not missing:
        return []
    with workers(jobs, None) as pool, Progress(console=wide_console(stderr=True), transient=True) as progress:
        task = progress.add_task("shards", total=len(missing))
        for future in as_completed([pool.submit(make, plan) for plan in missing]):
            future.result()
            progress.advance(task)
    return missing


def _require_same(plan: ShardPlan, path: Path) -> None:
    was, asked = (_flat(about) for about in (about_shard(path), plan.about))
    other = [
        f"{name} {was.get(name)}, now {value}" for name, value in asked.items() if was.get(name) != value
    ]
    if other:
        raise ExperimentError(
            f"shard {path} was drawn by another recipe ({'; '.join(other)}): choose another folder, or the "
            "recipe it was drawn by"
        )


def _flat(about: Mapping[str, Any]) -> dict[str, Any]:
    return {"pairs of a shard": about.get("planned"), **about["recipe"]}
