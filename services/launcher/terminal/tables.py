"""Figures, services and checks as tables for the shell."""

from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table

from services.launcher.processes.machine import Check
from services.launcher.processes.runner import State
from services.launcher.processes.state import ServiceStatus

PIPE_WIDTH = 160
"""Columns where there is no terminal to ask, for example in a log file."""

COLOURS = {
    State.HEALTHY: "green",
    State.DEGRADED: "bold red",
    State.EXITED: "red",
    State.SILENT: "red",
    State.RESTARTING: "yellow",
}


def print_figures(title: str, figures: Mapping[str, object]) -> None:
    """One row per plain figure; lists and nested figures stay in the JSON."""
    table = Table(title=title, show_header=False)
    for name, value in figures.items():
        if isinstance(value, str | int | float) or value is None:
            table.add_row(name, f"{value:g}" if isinstance(value, float) else str(value))
    wide_console().print(table)


def print_rows(title: str, rows: Sequence[Mapping[str, object]], columns: Sequence[str] = ()) -> None:
    """One column per key of the first row, or those of `columns` alone."""
    table = Table(*(columns or (rows[0] if rows else ())), title=title)
    for row in rows:
        values = [row[name] for name in columns] if columns else list(row.values())
        table.add_row(*(f"{v:.3g}" if isinstance(v, float) else str(v) for v in values))
    wide_console().print(table)


def wide_console(*, stderr: bool = False) -> Console:
    """A console that does not break lines where nobody looks at a terminal."""
    console = Console(stderr=stderr)
    return console if console.is_terminal else Console(stderr=stderr, width=PIPE_WIDTH)


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
