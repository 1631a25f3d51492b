"""Services of a stack and checks of a machine as tables for the shell."""

from collections.abc import Mapping, Sequence

from rich.table import Table

from services.launcher.processes.machine import Check
from services.launcher.processes.runner import State
from services.launcher.processes.state import ServiceStatus

COLOURS = {
    State.HEALTHY: "green",
    State.DEGRADED: "bold red",
    State.EXITED: "red",
    State.SILENT: "red",
    State.RESTARTING: "yellow",
}


def status_table(services: Mapping[str, ServiceStatus]) -> Table:
    """One row per service."""
    table = Table("service", "state", "pid", "restarts", "last exit", box=None)
    for name, status in services.items():
        colour = COLOURS.get(status.state, "cyan")
        last = "" if status.last_exit is None else str(status.last_exit)
        state = f"[{colour}]{status.state.value}[/{colour}]"
        table.add_row(name, state, str(status.pid or ""), str(status.restarts), last)
    return table


def check_table(checks: Sequence[Check]) -> Table:
    """One row per check, and how to mend what failed."""
    table = Table("", "check", "found", "how to fix it", box=None)
    for check in checks:
        mark = "[green]OK[/green]" if check.ok else "[bold red]FAIL[/bold red]"
        table.add_row(mark, check.name, check.detail, check.fix)
    return table


class Changes:
    """Tells which services changed their state since the last look."""

    def __init__(self) -> None:
        self._last: dict[str, State] = {}

    def lines(self, services: Mapping[str, ServiceStatus]) -> list[str]:
        """Return one line per change."""
        changed = {
            n: s
            for n, s in services.items()
            if self._last.get(n) is not s.state and s.state is not State.WAITING
        }
        self._last |= {name: status.state for name, status in services.items()}
        return [
            f"{name:<10} {s.state.value}{f' (pid {s.pid})' if s.pid else ''}" for name, s in changed.items()
        ]
