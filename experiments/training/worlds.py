"""Generated worlds by kind, seed and size, and which of them may be trained on. Pure but for generating."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from services.launcher.client.failure import ExperimentError
from simulator.generation.generate import generate
from simulator.generation.kinds import KINDS, SIZES
from simulator.generation.splits import Split, split_of, worlds_of
from simulator.world.world_file import WorldFile

TRAINED_ON: Split = "development"
"""The only split that training may see; what is measured is measured on another."""


@dataclass(frozen=True)
class WorldName:
    """A generated world."""

    kind: str
    seed: int
    size: str

    def __str__(self) -> str:
        return f"{self.kind}-{self.seed}-{self.size}"

    @property
    def split(self) -> Split:
        """Development, validation or test: by a hash, not by what anybody says."""
        return split_of(self.kind, self.seed)

    def world(self) -> WorldFile:
        """Draw it; 1 to 5 s."""
        return WorldFile.model_validate(generate(self.kind, self.seed, self.size))

    @classmethod
    def parse(cls, text: str) -> "WorldName":
        """Read "flat-3-small".

        Raises:
            ExperimentError: the text names no generated world.
        """
        kind, _, rest = text.rpartition("-")
        kind, _, seed = kind.rpartition("-")
        if kind not in KINDS or not seed.isdigit() or rest not in SIZES:
            raise ExperimentError(
                f"a generated world is named as flat-3-small is, got {text!r}; kinds are {', '.join(KINDS)}, "
                f"sizes {', '.join(SIZES)}"
            )
        return cls(kind, int(seed), rest)


def first_worlds(
    split: Split, count: int, kinds: Sequence[str] = (), sizes: Sequence[str] = ()
) -> list[WorldName]:
    """The first so many worlds of a split, kinds and sizes in turn.

    Raises:
        ValueError: no such kind or size.
    """
    return [WorldName(*each) for each in islice(worlds_of({split}, kinds, sizes), count)]


def require_trainable(worlds: Sequence[WorldName], what: str) -> None:
    """Refuse worlds that others are judged by.

    Args:
        worlds: those that training would see.
        what: where they come from, for the message.

    Raises:
        ExperimentError: one is not of the development split.
    """
    for world in worlds:
        if world.split != TRAINED_ON:
            raise ExperimentError(
                f"{what}: world {world} is of the {world.split} split, training takes {TRAINED_ON} worlds "
                "only: what was trained on a world cannot be judged there"
            )
