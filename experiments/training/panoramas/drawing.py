"""Pairs of panoramas for a step of training, every two of one shard a possible pair."""

from typing import Protocol

import numpy as np
import numpy.typing as npt
import torch

from services.launcher.client.failure import ExperimentError

Numbers = npt.NDArray[np.int64]


class Placed(Protocol):
    """N panoramas of which is known where they are, and what they see of one another (`store.Panoramas`)."""

    @property
    def positions_m(self) -> torch.Tensor:
        """(N, 3) of the cameras."""

    @property
    def shard(self) -> torch.Tensor:
        """(N,) number of the shard of each."""

    @property
    def overlap(self) -> torch.Tensor:
        """(N, N) share of the directions of each that another sees."""

    def __len__(self) -> int:
        """N."""


class Pairs:
    """Draws pairs that see the same things, and others."""

    def __init__(self, panoramas: Placed, least: float, apart_m: float) -> None:
        """Find those that can be had.

        Args:
            panoramas: of all shards.
            least: overlap of either that makes a pair.
            apart_m: most distance of a pair.

        Raises:
            ExperimentError: there is none.
        """
        overlap = panoramas.overlap.float()
        here, there = torch.nonzero((overlap >= least) & (least <= overlap.T)).T.cpu()
        positions = panoramas.positions_m.cpu()
        near = ((positions[here] - positions[there]).norm(dim=-1) <= apart_m) & (here != there)
        self._pairs: Numbers = torch.stack([here[near], there[near]], dim=1).numpy()
        self._shard: Numbers = panoramas.shard.cpu().numpy()
        if not len(self._pairs):
            raise ExperimentError(
                f"of {len(panoramas)} panoramas no two within {apart_m:g} m see {least:.0%} of one another: "
                "draw more pairs with 'topnav train data', or choose a recipe with a smaller overlap"
            )

    def __len__(self) -> int:
        return len(self._pairs)

    def draw(self, count: int, rng: np.random.Generator, others: float = 0.0) -> Numbers:
        """(count, 2) numbers of panoramas; a share `others` of them any two of one shard, or of any."""
        pairs = self._pairs[rng.integers(len(self._pairs), size=count)]
        for row in np.flatnonzero(rng.random(count) < others):
            here = int(rng.integers(len(self._shard)))
            pool = np.arange(len(self._shard)) != here
            if rng.random() < 0.7:
                pool &= self._shard == self._shard[here]
            pairs[row] = here, int(rng.choice(np.flatnonzero(pool)))
        return pairs
