"""Which generated worlds are for building, which for judging: drawn once for all by a hash. Pure."""

import hashlib
from collections.abc import Collection, Iterator, Sequence
from itertools import count
from typing import Literal

from simulator.generation.kinds import KINDS, SIZES

Split = Literal["development", "validation", "test"]

SHARES: dict[Split, int] = {"development": 60, "validation": 20, "test": 20}
"""Of a hundred seeds; chosen: most to build with, as many to judge with as are never looked at."""


def split_of(kind: str, seed: int) -> Split:
    """The split of a world: another code version or another size never moves it."""
    drawn = int.from_bytes(hashlib.sha256(f"{kind}-{seed}".encode()).digest()[:8]) % sum(SHARES.values())
    below = 0
    for split, share in SHARES.items():
        below += share
        if drawn < below:
            return split
    raise AssertionError("shares sum up")


def worlds_of(
    splits: Collection[Split], kinds: Sequence[str] = (), sizes: Sequence[str] = ()
) -> Iterator[tuple[str, int, str]]:
    """Kind, seed and size of the worlds of some splits, without end: all kinds and sizes in turn.

    Args:
        splits: those whose worlds are wanted.
        kinds: only these; empty for all.
        sizes: only these; empty for all.

    Raises:
        ValueError: no such kind or size.
    """
    unknown = [f"kind {one!r}" for one in kinds if one not in KINDS]
    unknown += [f"size {one!r}" for one in sizes if one not in SIZES]
    if unknown:
        raise ValueError(
            f"unknown {', '.join(unknown)}; kinds are {', '.join(KINDS)}, sizes {', '.join(SIZES)}"
        )
    for seed in count():
        for k, kind in enumerate(KINDS):
            size = SIZES[(seed + k) % len(SIZES)]
            if split_of(kind, seed) in splits and kind in (kinds or KINDS) and size in (sizes or SIZES):
                yield kind, seed, size
