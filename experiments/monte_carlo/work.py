"""Many independent pieces of work on all cores or a cluster, each kept when done: a study cut off goes on."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, as_completed
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import torch
from rich.console import Console
from rich.progress import Progress

from experiments.studies.workers import workers
from shared.geometry.sphere import FloatArray


def results_of(
    function: Callable[[Any], FloatArray],
    plans: Sequence[Any],
    folder: Path,
    console: Console,
    cluster: str | None = None,
    jobs: int | None = None,
) -> list[FloatArray]:
    """Results of function(plan) in the order of the plans.

    Args:
        function: importable by name, so that another process can run it.
        plans: frozen dataclasses; their text names the file of the result.
        folder: where results are kept.
        console: shows the progress.
        cluster: address of a Dask scheduler; None uses processes of this machine.
        jobs: how many of them; None for all cores.

    Raises:
        ExperimentError: the cluster does not answer.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{function.__name__}-{_key(plan)}.npy" for plan in plans]
    missing = [n for n, file in enumerate(files) if not file.exists()]
    if missing:
        with (
            workers(jobs or os.cpu_count() or 1, cluster) as pool,
            Progress(console=console, transient=True) as progress,
        ):
            task = progress.add_task(function.__name__.replace("_", " "), total=len(missing))
            futures: dict[Future[FloatArray], int] = {
                pool.submit(_alone, function, plans[n]): n for n in missing
            }
            for future in as_completed(futures):
                _keep(files[futures[future]], future.result())
                progress.advance(task)
    return [np.load(file, allow_pickle=False) for file in files]


def _alone(function: Callable[[Any], FloatArray], plan: Any) -> FloatArray:
    """One piece of work on one core: side by side, more threads only get in each other's way."""
    torch.set_num_threads(1)
    return function(plan)


def _key(plan: Any) -> str:
    return sha256(repr(plan).encode()).hexdigest()[:20]


def _keep(file: Path, values: FloatArray) -> None:
    new = file.with_suffix(".new.npy")
    np.save(new, values, allow_pickle=False)
    new.replace(file)
