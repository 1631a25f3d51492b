"""Damaging bytes: the usual operations of fuzzers, drawn from one seeded source."""

from collections.abc import Callable
from random import Random

INTERESTING = (0, 1, 2, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, 2**63 - 1, 2**64 - 1)
STACKED = 4


class Mutator:
    """Makes bad bytes of good ones.

    Args:
        random: the only source of chance.
        tokens: pieces of the format.
        max_bytes: longest result.
    """

    def __init__(self, random: Random, tokens: tuple[bytes, ...], max_bytes: int) -> None:
        self._random, self._tokens, self._max_bytes = random, tokens, max_bytes
        self._operations: tuple[Callable[[bytearray, bytes], None], ...] = (
            self._flip,
            self._overwrite,
            self._number,
            self._remove,
            self._repeat,
            self._insert,
            self._splice,
            self._cut,
        )

    def damaged(self, data: bytes, other: bytes) -> bytes:
        """One to four operations on `data`; `other` is a good input to take pieces of."""
        changed = bytearray(data)
        for _ in range(self._random.choice((1, 1, 2, STACKED))):
            self._random.choice(self._operations)(changed, other)
        return bytes(changed[: self._max_bytes])

    def _span(self, data: bytes | bytearray) -> slice:
        start = self._random.randint(0, len(data))
        return slice(start, start + min(len(data) - start, int(self._random.expovariate(1 / 24)) + 1))

    def _flip(self, data: bytearray, _other: bytes) -> None:
        if data:
            data[self._random.randrange(len(data))] ^= 1 << self._random.randrange(8)

    def _overwrite(self, data: bytearray, _other: bytes) -> None:
        if data:
            data[self._random.randrange(len(data))] = self._random.randrange(256)

    def _number(self, data: bytearray, _other: bytes) -> None:
        width = self._random.choice((1, 2, 3, 4, 8))
        value = self._random.choice(INTERESTING) & (256**width - 1)
        at = self._random.randint(0, max(0, len(data) - width))
        data[at : at + width] = value.to_bytes(width, self._random.choice(("big", "little")))

    def _remove(self, data: bytearray, _other: bytes) -> None:
        del data[self._span(data)]

    def _repeat(self, data: bytearray, _other: bytes) -> None:
        span = self._span(data)
        times = self._random.choice((1, 2, 8, 300, 20_000))
        room = max(0, self._max_bytes - len(data))
        data[span.stop : span.stop] = (bytes(data[span]) * times)[:room]

    def _insert(self, data: bytearray, _other: bytes) -> None:
        at = self._random.randint(0, len(data))
        piece = self._random.randbytes(self._random.randint(1, 8))
        if self._tokens and self._random.random() < 0.7:
            piece = self._random.choice(self._tokens)
        data[at : at + (len(piece) if self._random.random() < 0.5 else 0)] = piece

    def _splice(self, data: bytearray, other: bytes) -> None:
        data[self._span(data)] = other[self._span(other)]

    def _cut(self, data: bytearray, _other: bytes) -> None:
        del data[self._random.randint(0, len(data)) :]
