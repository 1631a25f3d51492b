"""The bus that a recording is replayed on: never one where the recorded robots live."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from services.launcher.client.address import find_address
from services.launcher.client.failure import ExperimentError
from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.output import wide_console
from shared.bus import Bus, open_bus, wait_until
from shared.transport.keys import is_robot

VIEWERS = ("map-store", "gateway")
SPEAKERS = {"simulator", "planner", "drive", "features"}
"""Services whose messages a replay would mix with."""

LOOK_FOR_S = 2.0
"""A session that was just opened learns only little by little who else is there."""


@contextmanager
def open_replay_bus(endpoint: str | None, data_dir: Path, robots: set[str]) -> Iterator[Bus]:
    """The bus of a running stack, or of a web page and a map store started for this command.

    Raises:
        ExperimentError: the stack is secured, or one of `robots` may live on it.
    """
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


def new_names(remap: list[str]) -> dict[str, str]:
    """Read "r1=ghost" as {"r1": "ghost"}.

    Raises:
        ExperimentError: a text that is no pair of robots' names.
    """
    names = {old: new for old, _, new in (text.partition("=") for text in remap)}
    wrong = [f"{old}={new}" for old, new in names.items() if not (is_robot(old) and is_robot(new))]
    if wrong:
        raise ExperimentError(f"--remap expects old=new, two names that robots may have, got {wrong[0]!r}")
    return names


def _refuse_mixing(bus: Bus, robots: set[str]) -> None:
    found: set[str] = set()

    def look() -> bool:
        found.update(SPEAKERS & set(bus.alive()))
        return bool(found)

    if robots and wait_until(look, LOOK_FOR_S):
        alive = ", ".join(sorted(found))
        raise ExperimentError(
            f"{alive} live here: a replay of {', '.join(sorted(robots))} would mix with them and may move a "
            f"robot. Use another --data-dir, or --remap {min(robots)}=ghost"
        )
