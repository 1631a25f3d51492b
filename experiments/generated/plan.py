"""Which generated worlds a suite plays in. Pure."""

from dataclasses import dataclass
from itertools import islice

from simulator.generation.splits import SHARES, Split, worlds_of

COVERED = 0.97
"""Coverage at which a map is as good as finished."""


@dataclass(frozen=True)
class WorldPlan:
    """A generated world, explored and then played in, as it was and rearranged.

    Attributes:
        kind, seed, size: of the world.
        rounds: of hide and seek in the world as it was mapped, and as many after it was rearranged.
        max_steps: a round is given up after so many frames.
        pipeline: of the features; None: the default one.
        profile: rules by which it is explored and played in; None: the default ones.
    """

    kind: str
    seed: int
    size: str
    rounds: int
    max_steps: int
    pipeline: str | None = None
    profile: str | None = None

    @property
    def name(self) -> str:
        """Folder name, unique within a suite."""
        return f"{self.kind}-{self.seed}-{self.size}"


def plan_worlds(
    split: str,
    worlds: int,
    rounds: int,
    max_steps: int,
    kinds: list[str],
    sizes: list[str],
    pipeline: str | None = None,
    profile: str | None = None,
) -> list[WorldPlan]:
    """The first so many worlds of a split.

    Args:
        split: 'development', 'validation' or 'test'.
        worlds: how many.
        rounds: per world, and as many after it was rearranged.
        max_steps: bound of a round.
        kinds: only these; empty for all.
        sizes: only these; empty for all.
        pipeline: of the features; None: the default one.
        profile: rules by which the worlds are explored and played in; None: the default ones.

    Raises:
        ValueError: no such split, kind or size.
    """
    if split not in SHARES:
        raise ValueError(f"--split must be one of {', '.join(SHARES)}, got {split!r}")
    chosen: Split = split
    fitting = (
        WorldPlan(kind, seed, size, rounds, max_steps, pipeline, profile)
        for kind, seed, size in worlds_of({chosen}, kinds, sizes)
    )
    return list(islice(fitting, worlds))
