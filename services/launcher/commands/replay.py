"""`topnav replay`: a recording goes over the bus again, for the web page and for services under test."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.client.address import find_address
from services.launcher.client.failure import ExperimentError
from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal import options
from services.launcher.terminal.tables import print_rows, wide_console
from services.recorder.channels import topic_of, topics_named
from services.recorder.player import Player, play
from services.recorder.recording import contents, read
from shared.bus import Bus, open_bus, wait_until
from shared.lifecycle import stop_on_signals
from shared.topics import NAME

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)

VIEWERS = ("map-store", "gateway")
SPEAKERS = {"simulator", "planner", "drive", "features"}
"""Services whose words a replay would mix with."""

LOOK_FOR_S = 2.0
"""A session that was just opened learns only little by little who else is there."""


@app.command()
def main(
    file: Annotated[Path, typer.Argument(help="A file of 'topnav record'.")],
    rate: Annotated[float, typer.Option(min=0.01, help="2 plays twice as fast.")] = 1.0,
    remap: Annotated[
        list[str] | None, typer.Option(help="Other name of a robot, as r1=ghost; may be repeated.")
    ] = None,
    without: Annotated[str, typer.Option(help='Topics to leave out, as "command,heading".')] = "delta",
    loop: Annotated[bool, typer.Option("--loop", help="Begin again at the end, until Ctrl+C.")] = False,
    endpoint: options.Endpoint = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Replay a recording into a running stack, or into a web page started for it.

    Maps are those of the data folder. A robot that lives is never mixed with a recorded one: --remap it.
    """
    names, left_out = _names(remap or []), topics_named(without)
    index = contents(file)
    robots = {found[1].get("robot") for key in index.counts if (found := topic_of(key)) is not None}
    stop = stop_on_signals()
    unnamed = {robot for robot in robots if robot} - names.keys()
    with _bus(endpoint, data_dir, unnamed) as bus:
        player = Player(bus, names, left_out)
        console = wide_console(stderr=True)
        console.print(f"replaying {index.duration_s:.1f} s at rate {rate:g}; Ctrl+C ends it", highlight=False)
        again = True
        while again and not stop.is_set():
            play(read(file), player.put, rate, stop)
            again = loop
    print_rows(str(file), [{"key": key, "messages": n} for key, n in sorted(player.counts.items())])


@contextmanager
def _bus(endpoint: str | None, data_dir: Path, robots: set[str]) -> Iterator[Bus]:
    """The bus of a running stack, or of a web page and a map store started for this command."""
    address = find_address(endpoint, data_dir)
    if address is not None:
        if address.certs is not None:
            raise ExperimentError(
                f"{address.endpoint} is secured: its router lets nobody speak for a robot, a replay neither. "
                "Leave --endpoint out and use a --data-dir where no stack runs"
            )
        with address.open() as bus:
            _refuse_mixing(bus, robots)
            yield bus
        return
    with Launcher(data_dir, only=VIEWERS) as launcher, open_bus(launcher.endpoint) as bus:
        wide_console(stderr=True).print(f"console {launcher.gateway_url}", highlight=False)
        yield bus


def _refuse_mixing(bus: Bus, robots: set[str]) -> None:
    alive: list[str] = []

    def met() -> bool:
        alive[:] = sorted(SPEAKERS & set(bus.alive()))
        return bool(alive)

    if robots and wait_until(met, LOOK_FOR_S):
        raise ExperimentError(
            f"{', '.join(alive)} live here: a replay of {', '.join(sorted(robots))} would mix with them and "
            f"may move a robot. Use another --data-dir, or --remap {min(robots)}=ghost"
        )


def _names(remap: list[str]) -> dict[str, str]:
    parts = [text.partition("=") for text in remap]
    names = {old: new for old, _, new in parts}
    wrong = [f"{old}={new}" for old, new in names.items() if not (NAME.match(old) and NAME.match(new))]
    if wrong:
        raise ExperimentError(f"--remap expects old=new in lower-case letters and digits, got {wrong[0]!r}")
    return names
