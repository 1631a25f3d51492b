"""Maps of any size from rendered nodes. Pure.

Beyond the nodes that were rendered, more are put together: each takes the features of four different rendered
nodes, a quarter of all round from each. They are features of real pictures, so they compete with the right
node as other streets of a campus would, though no such spot exists.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from services.features.pipeline.interfaces import FeatureSet, Float32Array

PARTS = 4
"""Sources of a node: with a quarter of its features from each, no rendered node is found in its stead."""


def nodes_of(real: Sequence[FeatureSet], count: int, rng: np.random.Generator) -> Iterator[FeatureSet]:
    """`count` nodes: the real ones first, as many as are needed."""
    yield from real[:count]
    for _ in range(count - len(real)):
        yield put_together([real[k] for k in rng.choice(len(real), PARTS, replace=False)], rng)


def put_together(sources: Sequence[FeatureSet], rng: np.random.Generator) -> FeatureSet:
    """A node that shows in each of its sectors what another of `sources` shows in that sector.

    It has the strongest features only, as many as the sources at most.
    """
    start = float(rng.uniform(-np.pi, np.pi))
    masks = [_sector(source.lonlat_rad, start, k, len(sources)) for k, source in enumerate(sources)]
    kept = list(zip(sources, masks, strict=True))
    sizes = [source.sizes_rad[mask] for source, mask in kept if source.sizes_rad is not None]
    unknown = len(sizes) < len(kept)
    scores = np.concatenate([source.scores[mask] for source, mask in kept])
    order = np.argsort(-scores, kind="stable")[: max(len(source) for source in sources)]
    return FeatureSet(
        np.concatenate([source.lonlat_rad[mask] for source, mask in kept])[order],
        scores[order],
        np.concatenate([source.descriptors[mask] for source, mask in kept])[order],
        None if unknown else np.concatenate(sizes)[order],
    )


def _sector(lonlat_rad: Float32Array, start: float, k: int, parts: int) -> np.ndarray:
    turn = np.remainder(lonlat_rad[:, 0] - start, 2 * np.pi) / (2 * np.pi)
    return np.asarray(np.minimum((turn * parts).astype(int), parts - 1) == k)
