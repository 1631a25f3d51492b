"""`topnav soak`: hours of missions under chaos; exit 1 when an invariant did not hold."""

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Annotated, Any

import typer
from rich.console import Console

from experiments.soak.chaos import Chaos
from experiments.soak.journal import Journal
from experiments.soak.ledger import Ledger
from experiments.soak.missions import Missions
from experiments.soak.monitor import Monitor
from experiments.soak.network import enter_own_network
from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.map_client import require_map
from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.terminal import options
from services.launcher.terminal.tables import print_rows
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)

TOLD_PERIOD_S = 60.0
SLOPE_NEEDS_S = 1800.0
"""A slope of a shorter time is told, not judged."""


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


@app.command()
def main(
    hours: Annotated[float, typer.Option(min=0.001, help="How long, with what --json has already.")] = 1.0,
    chaos: Annotated[bool, typer.Option(help="Kill, freeze and cut off at random.")] = True,
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    most_mb: Annotated[float, typer.Option(help="Memory that no service may pass, MB.")] = 2000.0,
    most_growth: Annotated[
        float, typer.Option(help="Growth that no service may pass once half an hour is known, MB/h.")
    ] = 100.0,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Drive to random places without end while services die, hang and lose each other.

    Never a collision, no acknowledged write lost, memory bounded, every mission ends in success or a failure
    with a name. A file of the same options is gone on with.
    """
    plan = Plan(world, map_name, seed, hours, most_mb, chaos, chaos and enter_own_network())
    journal = Journal(json_file, {"world": world, "map": map_name, "seed": seed, "chaos": chaos})
    with one_line_errors(), open_stack(StackChoice(data_dir, world, seed, lockstep=False)) as stack:
        require_map(stack, map_name)
        journal.start()
        _soak(stack, plan, journal)
    _judge_growth(journal, most_growth)
    journal.write()
    _tell(journal.summary())
    if journal.violations:
        raise ExperimentError(f"{journal.violations} violations of an invariant, see above and --json")


def _soak(stack: Stack, plan: Plan, journal: Journal) -> None:
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


def _judge_growth(journal: Journal, most_mb_per_h: float) -> None:
    for service, found in journal.summary()["growth"].items():
        if found["observed_s"] >= SLOPE_NEEDS_S and (found["mb_per_h"] or 0.0) > most_mb_per_h:
            journal.violation("memory is bounded", f"{service} grows by {found['mb_per_h']} MB an hour")


def _tell(summary: dict[str, Any]) -> None:
    rows = [{"service": service, **found} for service, found in summary.pop("growth").items()]
    print_rows("soak", [{"figure": name, "value": str(value)} for name, value in summary.items()])
    print_rows("memory", rows)
