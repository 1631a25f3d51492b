"""SIGKILL of the map store at random instants under a constant load, and the account kept of it."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import MapRequest
from shared.queries import QueryError, RefusedError
from shared.topics import MAP
from tests.faults.account import judge
from tests.faults.writers import OWN, SHARED, Link, Load
from tests.integration.map_store.conftest import Process

PATIENCE_S = 40.0
UNDO_S = 60.0
"""Never waited for: a killed process ends its connections. Given up early, an undo may be done after all."""

WRITES = 2
"""So many at least are acknowledged between two kills, however slow the machine is."""

KILLS_PER_MAP = 5
"""A new set of maps begins then, so that reading them back stays short."""

EARLY = 0.1
"""Share of kills that come while the process is still starting."""


@dataclass
class Report:
    """What came of it.

    Attributes:
        lost: acknowledged transactions that are not there, or not as they were written.
        corrupt: maps with damage, half a transaction or a gap in their history.
        wrong: each such thing in words.
        recovery_s: from the start of the process to its first answer on the bus.
    """

    kills: int = 0
    acknowledged: int = 0
    unacknowledged: int = 0
    found_committed: int = 0
    maps: int = 0
    lost: int = 0
    corrupt: int = 0
    wrong: list[str] = field(default_factory=list)
    recovery_s: list[float] = field(default_factory=list)

    def figures(self) -> dict[str, Any]:
        """For people and files."""
        recovery = self.recovery_s or [float("nan")]
        return asdict(self) | {
            "recovery_median_s": round(float(np.median(recovery)), 3),
            "recovery_max_s": round(max(recovery), 3),
            "recovery_s": [round(value, 3) for value in self.recovery_s],
        }


def kill_often(
    folder: Path,
    repository: Path,
    endpoint: str,
    port: int,
    kills: int,
    seed: int,
    longest_s: float = 0.8,
    tell: Callable[[Report], None] = lambda _: None,
) -> Report:
    """Run the map store in `folder`, kill it `kills` times, and check after each set of maps."""
    rng, report = np.random.default_rng(seed), Report()
    process = Process(repository, folder, endpoint, port, patient=True)
    client = httpx.Client(base_url=process.url, trust_env=False, timeout=UNDO_S)
    with open_bus(endpoint) as bus, client as rest:
        try:
            report.recovery_s.append(_start(process, bus))
            while report.kills < kills and not report.wrong:
                link = Link(bus, rest, f"{report.maps // len((SHARED, OWN))}")
                _round(process, link, rng, report, min(KILLS_PER_MAP, kills - report.kills), longest_s)
                tell(report)
            damage = rest.get("/check", timeout=PATIENCE_S).raise_for_status().json()["damage"]
            report.corrupt += len({entry["map"] for entry in damage})
            report.wrong += [str(entry) for entry in damage]
        finally:
            if process.child is not None and process.child.poll() is None:
                process.kill()
    return report


def _round(
    process: Process, link: Link, rng: np.random.Generator, report: Report, kills: int, longest_s: float
) -> None:
    """One set of maps: load, kills, restarts, and the account at the end."""
    load = Load(link, seed=int(rng.integers(2**32)))
    load.start()
    try:
        for _ in range(kills):
            before = load.acknowledged()
            if not wait_until(lambda before=before: load.acknowledged() >= before + WRITES, PATIENCE_S):
                report.wrong.append("nothing is acknowledged any more")
                break
            time.sleep(rng.uniform(0.0, longest_s))
            _kill(process, rng, report)
            report.recovery_s.append(_start(process, link.bus))
    finally:
        load.stop()
    for name, transactions in load.transactions().items():
        verdict = judge(link, name, transactions)
        report.maps += 1
        report.acknowledged += verdict.acknowledged
        report.unacknowledged += verdict.unacknowledged
        report.found_committed += verdict.found_committed
        report.lost += verdict.lost
        report.corrupt += bool(verdict.wrong)
        report.wrong += [f"{name}: {text}" for text in verdict.wrong]


def _kill(process: Process, rng: np.random.Generator, report: Report) -> None:
    """Kill the process, and sometimes the next one while it is still starting."""
    process.kill()
    report.kills += 1
    if rng.random() < EARLY:
        process.start()
        time.sleep(rng.uniform(0.0, 1.5))
        process.kill()
        report.kills += 1


def _start(process: Process, bus: Bus) -> float:
    """Seconds until a new process answers; a map that is not there is an answer too."""
    started_s = time.monotonic()
    process.start()

    def answers() -> bool:
        try:
            bus.ask(MAP, MapRequest(action="read"), 5.0, map="nobody")
        except QueryError as error:
            return isinstance(error, RefusedError) and error.code == "missing"
        return False

    assert wait_until(answers, PATIENCE_S), "the map store did not come back"
    return time.monotonic() - started_s
