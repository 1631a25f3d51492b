"""What happened in a soak, written to its file as it goes; any thread may add to it."""

import threading
import time
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

from experiments.soak.growth import Sample, growth
from experiments.work.results_file import ResultsFile

TABLES = ("events", "violations", "memory", "sessions")
WRITE_PERIOD_S = 20.0
"""What a soak that is killed forgets at most; writing hours of samples takes a fraction of a second."""


class Journal:
    """Tables of missions ("results"), chaos events, violations, memory and sessions.

    A file that is there already is gone on with: its time counts.
    """

    def __init__(self, path: Path | None, setup: dict[str, Any]) -> None:
        self._file = ResultsFile(path, setup, *TABLES)
        self._lock = threading.Lock()
        self._began_s = time.monotonic()
        self._before_s = sum(float(row["elapsed_s"]) for row in self._file.tables["sessions"])
        self._file.tables["sessions"].append({"elapsed_s": 0.0, "acknowledged_writes": 0})
        self._written_s = 0.0

    def start(self) -> None:
        """The time of this session counts from now on."""
        self._began_s = time.monotonic()

    @property
    def elapsed_s(self) -> float:
        """Time of all sessions together."""
        return self._before_s + time.monotonic() - self._began_s

    @property
    def violations(self) -> int:
        """How often an invariant did not hold."""
        return len(self._file.tables["violations"])

    def violation(self, invariant: str, why: str) -> None:
        """An invariant did not hold."""
        self.add("violations", invariant=invariant, why=why[:400], after=self._last_event())

    def add(self, table: str, **row: Any) -> None:
        """Keep a mission ("results"), what was done to the stack ("events"), or a sample ("memory")."""
        with self._lock:
            self._file.tables[table].append({"at_s": round(self.elapsed_s, 1), **row})
            if time.monotonic() - self._written_s > WRITE_PERIOD_S or table == "violations":
                self._write()

    def writes(self, acknowledged: int) -> None:
        """How many writes this session had acknowledged so far."""
        self._file.tables["sessions"][-1]["acknowledged_writes"] = acknowledged

    def write(self) -> None:
        """Write everything now."""
        with self._lock:
            self._write()

    def summary(self) -> dict[str, Any]:
        """Figures of everything so far."""
        tables = self._file.tables
        samples = [Sample(**row) for row in tables["memory"]]
        ends = Counter(row["failure"] or row["state"] for row in tables["results"])
        harms = Counter(row["harm"] for row in tables["events"])
        back = [row["healthy_after_s"] for row in tables["events"] if row["healthy_after_s"] is not None]
        return {
            "hours": round(self.elapsed_s / 3600.0, 3),
            "missions": len(tables["results"]),
            "succeeded": ends["succeeded"],
            "ends": dict(ends),
            "collisions": sum(row["invariant"] == "no collision" for row in tables["violations"]),
            "events": dict(harms),
            "healthy_again_max_s": max(back, default=None),
            "acknowledged_writes": sum(row["acknowledged_writes"] for row in tables["sessions"]),
            "violations": len(tables["violations"]),
            "growth": {service: asdict(found) for service, found in growth(samples).items()},
        }

    def _last_event(self) -> str:
        events = self._file.tables["events"]
        return f"{events[-1]['harm']} {events[-1]['service']} at {events[-1]['at_s']} s" if events else ""

    def _write(self) -> None:
        self._written_s = time.monotonic()
        elapsed_s = round(time.monotonic() - self._began_s, 1)
        self._file.tables["sessions"][-1]["elapsed_s"] = elapsed_s
        self._file.write(summary=self.summary())
