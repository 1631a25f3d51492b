"""Who does the work of a suite: processes of this machine, or the workers of a Dask cluster."""

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager

from services.launcher.client.failure import ExperimentError


@contextmanager
def workers(jobs: int, cluster: str | None) -> Iterator[Executor]:
    """An executor.

    Args:
        jobs: runs at a time on this machine; each is a whole stack.
        cluster: address of a Dask scheduler whose workers have topnav installed; None works here.

    Raises:
        ExperimentError: Dask is not installed, or no scheduler answers.
    """
    if cluster is None:
        # Fresh processes: a fork would copy the threads of the bus in whatever state they are.
        with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
            yield pool
        return
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise ExperimentError("--cluster needs Dask: pip install 'topnav[cluster]'") from None
    try:
        client = Client(cluster, timeout="15s")
    except (OSError, ValueError) as error:
        raise ExperimentError(f"no Dask scheduler answers at {cluster}: {error}") from None
    with client:
        yield client.get_executor(pure=False)
