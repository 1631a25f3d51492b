"""One vector for a whole panorama: how its words lie around the centres of their kinds. Pure.

VLAD (Jegou et al. 2010) with unit residuals and with each kind of unit length ("All about VLAD", Arandjelovic
and Zisserman 2013). It knows nothing of where words lie, so turning the camera does not change it.
"""

import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import Float32Array

TINY = np.float32(1e-9)


def vlad(vectors: Float32Array, kinds: Float32Array) -> Float32Array:
    """Aggregate (N, D) descriptors around (K, D) centres into a unit vector (K * D,); zero without words."""
    distances = np.einsum("kd,kd->k", kinds, kinds) - np.float32(2.0) * (vectors @ kinds.T)
    nearest = distances.argmin(axis=1)
    belongs = np.zeros((len(kinds), len(vectors)), dtype=np.float32)
    belongs[nearest, np.arange(len(vectors))] = 1.0
    sums = belongs @ unit(vectors - kinds[nearest])
    return unit(unit(sums).reshape(-1))


def unit(rows: npt.NDArray[np.float32]) -> Float32Array:
    """Each vector along the last axis with length one; zero stays zero."""
    lengths: Float32Array = np.sqrt(np.einsum("...d,...d->...", rows, rows))[..., None]
    return np.asarray(rows / np.maximum(lengths, TINY), dtype=np.float32)
