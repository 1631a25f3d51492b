"""Two painted places, as training reads them: four panoramas of one shard, two of another."""

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import torch

from experiments.training.data.shards import Pair, trainable
from experiments.training.panoramas.store import Panoramas, load_panoramas
from experiments.training.sights import CameraPose, Sight
from experiments.training.worlds import first_worlds
from tests.unit.experiments.training.patch.painted import painted, painted_pair, write_painted

LEANING, LOW = CameraPose(-1.2, 1.0, -2.0, 0.5, (0.05, -0.03)), CameraPose(2.9, -1.5, 2.5, -0.6)
HALF_UNKNOWN, HIDDEN = 2, 3
"""Numbers of the panorama whose right half shows no surface, and of the one that sees what no other does."""
CPU = torch.device("cpu")


@dataclass(frozen=True)
class Places:
    """Shards, what they hold, and the same as tensors."""

    files: list[Path]
    sights: list[Sight]
    panoramas: Panoramas


def written_places(folder: Path) -> Places:
    """Two shards in a folder."""
    half = painted(LEANING)
    half.ranges_m[:, half.ranges_m.shape[1] // 2 :] = float("inf")
    rest = Pair(half, painted(LOW, hidden=True), (0.5, 0.0))
    contents = [painted_pair(), rest], [painted_pair()]
    worlds = first_worlds("development", len(contents))
    files = [write_painted(folder, world, pairs) for world, pairs in zip(worlds, contents, strict=True)]
    pairs = [pair for file in files for pair in trainable(file).pairs]
    sights = [sight for pair in pairs for sight in (pair.here, pair.there)]
    return Places(files, sights, load_panoramas(files, CPU))


@contextmanager
def in_this_process(jobs: int, cluster: str | None) -> Iterator[Executor]:
    """In place of `workers`, whose processes take seconds to begin."""
    assert cluster is None
    with ThreadPoolExecutor(jobs) as pool:
        yield pool
