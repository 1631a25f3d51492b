"""Many executions of one decoder, and what is kept of them."""

import hashlib
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any, Protocol

from tests.fuzz.decoder import Decoder
from tests.fuzz.mutation import Mutator
from tests.fuzz.trees import damaged_tree, random_tree
from tests.fuzz.watch import Outcome, Watch

MOST_KEPT = 3
"""Inputs kept of one kind of crash."""
MOST_POOLED = 300
FRESH = 0.08
"""Share of inputs that are made from nothing."""


class Notes(Protocol):
    """Where the input that is being executed survives the end of the process."""

    def note(self, data: bytes) -> None:
        """An execution begins."""

    def done(self) -> None:
        """It is over."""


@dataclass
class Tally:
    """What one decoder did.

    Attributes:
        counts: executions by outcome.
        ways: distinct ways to refuse.
        crashes: what was told, once for each kind.
        slowest_s, hungriest_mb: the most that one execution within the limits took.
    """

    decoder: str
    counts: Counter[str] = field(default_factory=Counter)
    ways: int = 0
    crashes: list[str] = field(default_factory=list)
    slowest_s: float = 0.0
    hungriest_mb: float = 0.0
    seconds: float = 0.0

    def as_json(self) -> dict[str, Any]:
        """For the report."""
        return vars(self) | {"counts": dict(self.counts), "executions": self.counts.total()}


class Campaign:
    """Fuzzes one decoder.

    Args:
        decoder: what is fuzzed.
        seed: of all chance; the same seed gives the same inputs.
        keep: folder for the inputs that crash it.
        current: told every input before it is executed, for those that end the process.
    """

    def __init__(self, decoder: Decoder, seed: int, keep: Path, current: Notes) -> None:
        self.tally = Tally(decoder.name)
        self._decoder, self._keep, self._current = decoder, keep, current
        self._random = Random(f"{decoder.name} {seed}")
        self._mutator = Mutator(self._random, decoder.tokens, decoder.max_bytes)
        self._pool = list(decoder.seeds)
        self._seen: set[str] = set()
        self._kept: Counter[str] = Counter()
        self._watch = Watch()

    def run(self, executions: int | None, seconds: float | None) -> Tally:
        """Execute the seeds, then damaged inputs until there were so many or so much time has passed."""
        began_s = time.monotonic()
        for seed in self._decoder.seeds:
            self._execute(seed)
        while (executions is None or self.tally.counts.total() < executions) and (
            seconds is None or time.monotonic() - began_s < seconds
        ):
            self._execute(self._next())
        self.tally.seconds = time.monotonic() - began_s
        return self.tally

    def _next(self) -> bytes:
        base, other = self._random.choice(self._pool), self._random.choice(self._pool)
        shape = self._decoder.shape
        if shape is not None and self._random.random() < 0.5:
            fresh = self._random.random() < FRESH
            try:
                tree = random_tree(self._random) if fresh else damaged_tree(self._random, shape.unfold(base))
                return shape.fold(tree)[: self._decoder.max_bytes]
            except (ValueError, TypeError, ArithmeticError, LookupError, RecursionError):
                pass  # the base is no tree any more, or the tree has no bytes
        if self._random.random() < FRESH:
            return self._random.randbytes(self._random.randrange(400))
        return self._mutator.damaged(base, other)

    def _execute(self, data: bytes) -> None:
        self._current.note(data)
        outcome = self._watch.run(self._decoder, data)
        self._current.done()
        self.tally.counts[outcome.kind] += 1
        if outcome.bad:
            self._remember(data, outcome)
            return
        self.tally.slowest_s = max(self.tally.slowest_s, outcome.cpu_s)
        self.tally.hungriest_mb = max(self.tally.hungriest_mb, outcome.memory_mb)
        if outcome.told not in self._seen:  # reached something new: worth damaging further
            self._seen.add(outcome.told)
            self.tally.ways += outcome.kind == "refused"
            if len(self._pool) < MOST_POOLED:
                self._pool.append(data)

    def _remember(self, data: bytes, outcome: Outcome) -> None:
        head = f"{outcome.kind}: {outcome.told.partition(chr(10))[0]}"
        if not self._kept[head]:
            self.tally.crashes.append(head)
        self._kept[head] += 1
        if self._kept[head] <= MOST_KEPT:
            keep_input(self._keep, self._decoder.name, data, f"{outcome.kind}: {outcome.told}")


def keep_input(folder: Path, decoder: str, data: bytes, why: str) -> Path:
    """Write an input and why it is kept; returns its file."""
    place = folder / decoder
    place.mkdir(parents=True, exist_ok=True)
    file = place / f"{hashlib.sha256(data).hexdigest()[:16]}.bin"
    file.write_bytes(data)
    file.with_suffix(".txt").write_text(why, encoding="utf-8", errors="replace")
    return file
