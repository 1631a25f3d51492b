"""One session of a soak: everything at once until the time is up; then the growth of memory is judged."""

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from rich.console import Console

from experiments.soak.chaos import Chaos
from experiments.soak.journal import Journal
from experiments.soak.ledger import Ledger
from experiments.soak.missions import Missions
from experiments.soak.monitor import Monitor
from services.launcher.client.failure import ExperimentError
from services.launcher.client.stack import Stack
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

TOLD_PERIOD_S = 60.0  # a log of hours stays short
SLOPE_NEEDS_S = 1800.0
"""A slope of a shorter time is told, not judged: caches fill for minutes."""

Job = Callable[[threading.Event], None]


@dataclass(frozen=True)
class Plan:
    """What to do for how long."""

    world: str
    map_name: str
    seed: int
    hours: float
    most_mb: float
    chaos: bool
    may_cut: bool


def soak(stack: Stack, plan: Plan, journal: Journal) -> None:
    """Everything at once until the time is up or somebody interrupts."""
    if stack.launcher is None:
        raise ExperimentError(
            "a stack runs in this data folder: stop it ('topnav down'), soak starts its own"
        )
    console, stop = Console(stderr=True), threading.Event()
    seed = plan.seed + int(journal.elapsed_s)  # a session that goes on draws anew
    jobs: list[Job] = [
        Missions(stack, free_space(load_world(plan.world)), plan.map_name, seed, journal).run,
        Ledger(stack.endpoint, journal).run,
        Monitor(stack.launcher, stack.robot, journal, plan.most_mb).run,
    ]
    if plan.chaos:
        jobs.append(Chaos(stack.launcher, journal, seed, may_cut=plan.may_cut).run)
        console.print("the network is cut too" if plan.may_cut else "no network of our own: it is not cut")
    with ExitStack() as running:
        for job in jobs:
            running.enter_context(_in_thread(job, stop, journal))
        try:
            while (left_s := plan.hours * 3600.0 - journal.elapsed_s) > 0.0:
                stop.wait(min(TOLD_PERIOD_S, left_s))
                told = journal.summary()
                console.print({name: told[name] for name in ("hours", "missions", "ends", "violations")})
        except KeyboardInterrupt:
            console.print("interrupted: what is known so far is kept")
        finally:
            stop.set()


@contextmanager
def _in_thread(job: Job, stop: threading.Event, journal: Journal) -> Iterator[None]:
    """Run a job beside the others; one that fails is a violation: nobody watches its invariant any more."""

    def run() -> None:
        try:
            job(stop)
        except Exception as error:  # noqa: BLE001 - whatever it was, the run must tell it
            journal.violation("soak itself works", f"{job.__qualname__}: {type(error).__name__}: {error}")

    thread = threading.Thread(target=run, name=job.__qualname__)
    thread.start()
    try:
        yield
    finally:
        thread.join()


def judge_growth(journal: Journal, most_mb_per_h: float) -> None:
    """A service that grows faster than that, once half an hour is known, is a violation."""
    for service, found in journal.summary()["growth"].items():
        if found["observed_s"] >= SLOPE_NEEDS_S and (found["mb_per_h"] or 0.0) > most_mb_per_h:
            journal.violation("memory is bounded", f"{service} grows by {found['mb_per_h']} MB an hour")
