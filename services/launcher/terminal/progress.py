"""What a person sees while a mission runs: steps, rate, nodes, similarity, reason of the last decision."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from shared.messages.missions import MissionStatus

LINE_PERIOD_S = 20.0
"""Between two lines where nobody looks at a terminal: a log of an hour stays short."""

Watch = Callable[[MissionStatus], None]


@contextmanager
def mission_progress(console: Console, title: str) -> Iterator[Watch]:
    """A live line on a terminal, a plain line every 20 s elsewhere."""
    start_s = time.monotonic()
    if not console.is_terminal:
        yield _plain_lines(console, title, start_s)
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(title)
        yield lambda status: progress.update(task, description=f"{title}: {describe(status, start_s)}")


class LinesNowAndThen:
    """Passes on a line every LINE_PERIOD_S: the first after as long."""

    def __init__(self, say: Callable[[str], None]) -> None:
        """Pass lines on to `say`."""
        self._say, self._last_s = say, time.monotonic()

    def __call__(self, text: str) -> None:
        """Pass this one on if it is time."""
        now_s = time.monotonic()
        if now_s - self._last_s >= LINE_PERIOD_S:
            self._last_s = now_s
            self._say(text)


@contextmanager
def stage_progress(console: Console, title: str) -> Iterator[Callable[[str, int, int], None]]:
    """The same for work in stages: told the stage, how much of it is done and how much there is, or 0."""
    if not console.is_terminal:
        lines = LinesNowAndThen(lambda text: console.print(text, highlight=False, markup=False))
        yield lambda stage, done, count: lines(_stage(title, stage, done, count))
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(title)

        def show(stage: str, done: int, count: int) -> None:
            progress.update(task, description=escape(_stage(title, stage, done, count)))

        yield show


@contextmanager
def start_progress() -> Iterator[Callable[[str], None]]:
    """What a stack that starts is waiting for, on standard error; nothing where it is up at once."""
    console = Console(stderr=True, soft_wrap=True)
    with stage_progress(console, "starting") as progress:
        yield lambda text: progress(text, 0, 0)


def _plain_lines(console: Console, title: str, start_s: float) -> Watch:
    lines = LinesNowAndThen(lambda text: console.print(text, highlight=False))
    return lambda status: lines(f"{title}: {describe(status, start_s)}")


def _stage(title: str, stage: str, done: int, count: int) -> str:
    return f"{title}: {stage}" + (f" {done}/{count}" if count > 1 else "")


def describe(status: MissionStatus, start_s: float) -> str:
    """One line about a running mission."""
    rate = status.step / max(time.monotonic() - start_s, 1e-9)
    waypoint = f", via {status.via_index + 1}/{len(status.via_points)}" if status.via_points else ""
    shown = {figure.name for figure in status.figures}
    frontiers = f", {status.open_directions} open" if "open_directions" in shown else ""
    return (
        f"step {status.step}, {rate:.1f} steps/s, {status.nodes} nodes, {status.edges} edges"
        f"{frontiers}{waypoint}, S {status.similarity}: {status.reason[:60]}"
    )
