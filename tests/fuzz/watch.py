"""One execution under watch: what came of it, its CPU time, and the memory that it took for itself."""

import re
import resource
import time
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.fuzz.decoder import Decoder

VARYING = re.compile(r"\d+|'[^']*'|\"[^\"]*\"|\\x..")
"""What differs between two refusals of the same kind."""
MEGABYTE = 1_000_000
TRIES = 3
"""The garbage collector, the first use of a library or a busy processor do not break a limit every time."""

Kind = Literal["accepted", "refused", "crash", "slow", "hungry"]


@dataclass(frozen=True)
class Outcome:
    """What came of one input.

    Attributes:
        kind: "slow" and "hungry" broke the decoder's limits of time and memory.
        told: the error without what varies; with its traceback for crashes.
        cpu_s: CPU time.
        memory_mb: highest resident memory during the execution above that before it.
    """

    kind: Kind
    told: str
    cpu_s: float
    memory_mb: float

    @property
    def bad(self) -> bool:
        """Whether a decoder must not do this."""
        return self.kind in ("crash", "slow", "hungry")


class Watch:
    """Executes decoders. Resident memory counts what C libraries take, which Python's own tracing misses."""

    def __init__(self) -> None:
        self._peak = _PeakMemory()

    def run(self, decoder: Decoder, data: bytes) -> Outcome:
        """Execute once; a limit counts as broken when some more executions break it too."""
        outcome = self._once(decoder, data)
        for _ in range(TRIES - 1):
            if outcome.kind in ("slow", "hungry"):
                outcome = self._once(decoder, data)
        return outcome

    def _once(self, decoder: Decoder, data: bytes) -> Outcome:
        self._peak.begin()
        began_s = time.thread_time()
        kind, told = _outcome(decoder, data)
        cpu_s, memory_mb = time.thread_time() - began_s, self._peak.grown_mb()
        if kind != "crash" and cpu_s > decoder.cpu_s:
            kind, told = "slow", f"at most {decoder.cpu_s:g} s of CPU time expected; {told}"
        elif kind != "crash" and memory_mb > decoder.memory_mb:
            kind, told = "hungry", f"at most {decoder.memory_mb} MB more expected; {told}"
        return Outcome(kind, told, cpu_s, memory_mb)


def _outcome(decoder: Decoder, data: bytes) -> tuple[Kind, str]:
    try:
        decoder.decode(data)
    except decoder.refusals as error:
        return "refused", f"{type(error).__name__}: {VARYING.sub('#', str(error)[:300])[:100]}"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001  panics of Rust libraries and SystemExit are crashes too
        last = traceback.extract_tb(error.__traceback__)[-1]
        head = f"{type(error).__name__} in {Path(last.filename).name}:{last.lineno}"
        return "crash", f"{head}\n{''.join(traceback.format_exception(error))}"
    return "accepted", ""


class _PeakMemory:
    """Highest resident memory since `begin`, by Linux's own mark where it can be set back."""

    def __init__(self) -> None:
        self._before_kb = 0
        self._marks = Path("/proc/self/clear_refs")
        try:
            self._marks.write_text("5")
            self._resettable = True
        except OSError:
            self._resettable = False

    def begin(self) -> None:
        if self._resettable:
            self._marks.write_text("5")
            self._before_kb = self._status_kb("VmHWM:")
        else:
            self._before_kb = self._status_kb("VmRSS:")

    def grown_mb(self) -> float:
        most_kb = (
            self._status_kb("VmHWM:")
            if self._resettable
            else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        )
        return max(0, most_kb - self._before_kb) * 1024 / MEGABYTE

    def _status_kb(self, name: str) -> int:
        text = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
        return int(text.partition(name)[2].split(maxsplit=1)[0])
