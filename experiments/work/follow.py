"""How far the jobs of a study are, until the last has ended."""

import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

POLL_S = 1.0  # a round takes 20 s and more


def follow(
    console: Console, title: str, jobs: Sequence[Future[Any]], total: int, done: Callable[[], int]
) -> None:
    """Show how far the work is until all of it has ended; one failed job ends the others' wait."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(title, total=total)
        last = -1
        while True:
            pending = wait(jobs, timeout=POLL_S).not_done
            count = done()
            progress.update(task, completed=count)
            if count != last and not console.is_terminal:
                console.print(f"{time.strftime('%H:%M:%S')} {title}: {count}/{total}", highlight=False)
            last = count
            for job in jobs:
                if job.done():
                    job.result()
            if not pending:
                return
