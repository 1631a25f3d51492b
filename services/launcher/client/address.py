"""Where a command finds the bus of a running stack, and who it is there."""

import os
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from services.launcher.client.failure import ExperimentError
from services.launcher.processes.state import StateFolder
from shared.bus import Bus, open_bus


@dataclass(frozen=True)
class Address:
    """A router, and the folder of the certificate to show it; None on an open bus."""

    endpoint: str
    certs: Path | None = None

    def open(self) -> AbstractContextManager[Bus]:
        """Join the bus; raises the errors of `open_bus`."""
        return open_bus(self.endpoint, certs=self.certs)


def find_address(endpoint: str | None, data_dir: Path) -> Address | None:
    """The stack at `endpoint`, else the one that runs in `data_dir`; None when none runs there."""
    running = StateFolder(data_dir.resolve()).read()
    if running is not None and endpoint in (None, running.endpoint):
        return Address(running.endpoint, running.certs)
    return None if endpoint is None else address_at(endpoint)


def running_address(endpoint: str | None, data_dir: Path) -> Address:
    """The stack that `find_address` finds.

    Raises:
        ExperimentError: none runs in `data_dir`, and `endpoint` names no other.
    """
    address = find_address(endpoint, data_dir)
    if address is None:
        why = f"no stack runs in {data_dir}: start one with 'topnav up', or name another by --endpoint"
        raise ExperimentError(why)
    return address


def address_at(endpoint: str) -> Address:
    """A stack elsewhere: joined with the certificate in TOPNAV_CERTS, if that is set."""
    own = os.environ.get("TOPNAV_CERTS")
    return Address(endpoint, Path(own) if own else None)
