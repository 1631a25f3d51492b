"""missions.jsonl: one line per mission that ended, the oldest dropped now and then."""

import logging
import os
from datetime import UTC, datetime
from pathlib import Path

from pydantic import ValidationError

from services.gateway.http.metrics import Metrics
from services.gateway.live.mission_watch import MissionEntry, MissionWatch
from shared.messages.missions import MissionStatus

log = logging.getLogger(__name__)

FILE = "missions.jsonl"
KEPT = 1000
FULL = 2000
"""With more lines than that the file is cut back to the newest KEPT."""
MAX_BYTES = 8_000_000
"""Read of a file that something else made longer; FULL lines take a quarter of it."""


class MissionLog:
    """The file and who writes it. A folder that cannot be written costs the record, never a mission."""

    def __init__(self, folder: Path, metrics: Metrics) -> None:
        self._path, self._metrics = folder / FILE, metrics
        self._watch = MissionWatch()
        self._lines = 0
        try:
            self._count(*read_missions(self._path))
        except OSError as error:
            log.warning("cannot read %s: %s", self._path, error)

    def take(self, status: MissionStatus) -> None:
        """Record the mission of `status` if it just ended."""
        entry = self._watch.take(status, datetime.now(UTC))
        if entry is None:
            return
        try:
            self._append(entry)
            if self._lines > FULL:
                self._cut()
        except OSError as error:
            self._metrics.records_lost.inc()
            log.warning("mission %s may be missing from %s: %s", entry.mission_id, self._path, error)

    def ordered(self, status: MissionStatus, seed: int) -> None:
        """Remember the seed of a mission that was started here."""
        self._watch.ordered(status.robot, status.mission_id, seed)

    def _append(self, entry: MissionEntry) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with self._path.open("ab+") as file:
            # A process that was killed may have left half a line: it must not swallow this one.
            half = file.tell() > 0 and file.seek(-1, os.SEEK_END) >= 0 and file.read(1) != b"\n"
            file.write((b"\n" if half else b"") + entry.model_dump_json().encode() + b"\n")
        self._lines += 1

    def _cut(self) -> None:
        kept = read_missions(self._path)[0][-KEPT:]
        new = self._path.with_name(FILE + ".new")
        new.write_text("".join(f"{entry.model_dump_json()}\n" for entry in kept), encoding="utf-8")
        new.replace(self._path)
        self._count(kept, 0)

    def _count(self, entries: list[MissionEntry], broken: int) -> None:
        self._lines = len(entries) + broken
        self._watch.know({entry.key for entry in entries})


def read_missions(path: Path) -> tuple[list[MissionEntry], int]:
    """Missions on record, oldest first, and how many lines could not be read; no file is none.

    Raises:
        OSError: the file is there and cannot be read.
    """
    try:
        with path.open("rb") as file:
            skipped = max(0, file.seek(0, os.SEEK_END) - MAX_BYTES)
            file.seek(skipped)
            lines = file.read(MAX_BYTES).splitlines()
    except FileNotFoundError:
        return [], 0
    entries, broken = [], 0
    for line in lines[1:] if skipped else lines:
        try:
            entries.append(MissionEntry.model_validate_json(line))
        except ValidationError:
            broken += 1
    return entries, broken
