"""What is fuzzed: what turns bytes of strangers into an object, or refuses them with its own error."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Shape:
    """How bytes unfold into lists, maps and plain values, so that damage can be done below the syntax.

    Attributes:
        unfold: bytes -> tree; raises ValueError where they are none.
        fold: tree -> bytes; raises ValueError or TypeError where a value has no form.
    """

    unfold: Callable[[bytes], Any]
    fold: Callable[[Any], bytes]


@dataclass(frozen=True)
class Decoder:
    """One way in.

    Attributes:
        name: "family/what", as the command line takes it.
        decode: returns when it accepts; anything raised that is not one of `refusals` is a crash.
        refusals: the errors that it documents.
        seeds: good inputs to damage.
        tokens: pieces of the format that random bytes would not hit upon.
        shape: None for formats that are damaged as bytes only.
        cpu_s: most CPU time of one execution.
        memory_mb: most memory (MB) that one execution may take for itself, given back or not.
        max_bytes: longest input made.
    """

    name: str
    decode: Callable[[bytes], object]
    refusals: tuple[type[Exception], ...]
    seeds: tuple[bytes, ...]
    tokens: tuple[bytes, ...] = ()
    shape: Shape | None = None
    cpu_s: float = 1.0
    memory_mb: int = 64
    max_bytes: int = 200_000
