"""Who does the work of a study: processes of this machine, or the workers of a Dask cluster."""

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import Progress

from services.launcher.client.failure import ExperimentError
from shared.geometry.sphere import FloatArray

WATCH_S = 0.5
STOPPED_S = 20.0
"""Longer than a stack needs to stop (stop_grace_period of docker-compose.yml); chosen."""


@contextmanager
def workers(jobs: int, cluster: str | None) -> Iterator[Executor]:
    """An executor.

    Args:
        jobs: runs at a time on this machine.
        cluster: address of a Dask scheduler whose workers have topnav-studies installed; None works here.

    Raises:
        ExperimentError: Dask is not installed, or no scheduler answers.
    """
    if cluster is None:
        # Fresh processes: a fork would copy the threads of the bus in whatever state they are.
        fresh = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(jobs, fresh, initializer=_end_with, initargs=(os.getpid(),)) as pool:
            yield pool
        return
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise ExperimentError("--cluster needs Dask: pip install 'topnav[studies]'") from None
    try:
        client = Client(cluster, timeout="15s")
    except (OSError, ValueError) as error:
        raise ExperimentError(f"no Dask scheduler answers at {cluster}: {error}") from None
    with client:
        yield client.get_executor(pure=False)


def results_of(
    function: Callable[[Any], FloatArray],
    plans: Sequence[Any],
    folder: Path,
    console: Console,
    cluster: str | None = None,
    jobs: int | None = None,
) -> list[FloatArray]:
    """Results of function(plan) in the order of the plans, each kept when done: a study cut off goes on.

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
                pool.submit(_on_one_core, function, plans[n]): n for n in missing
            }
            for future in as_completed(futures):
                _keep(files[futures[future]], future.result())
                progress.advance(task)
    return [np.load(file, allow_pickle=False) for file in files]


def _end_with(parent: int) -> None:
    """Have this worker end when who gave it work is gone: a stack that it started would run for ever."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs behind a shell ignores it
    main = threading.main_thread().ident
    assert main is not None

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(WATCH_S)
        signal.pthread_kill(main, signal.SIGINT)  # wakes the main thread, which stops what it runs
        time.sleep(STOPPED_S)
        os._exit(1)  # it waits for work that nobody gives any more

    threading.Thread(target=watch, name="parent", daemon=True).start()


def _on_one_core(function: Callable[[Any], FloatArray], plan: Any) -> FloatArray:
    """Side by side, more threads only get in each other's way."""
    import torch

    torch.set_num_threads(1)
    return function(plan)


def _key(plan: Any) -> str:
    return sha256(repr(plan).encode()).hexdigest()[:20]


def _keep(file: Path, values: FloatArray) -> None:
    new = file.with_suffix(".new.npy")
    np.save(new, values, allow_pickle=False)
    new.replace(file)
