"""How much of the free floor a map covers. Pure."""

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
CHUNK = 4096


def coverage(floor_m: FloatArray, nodes_m: FloatArray, radius_m: float = 1.0) -> float:
    """Fraction of floor points within `radius_m` of a node.

    Args:
        floor_m: (N, 2) centres of equal cells of the free floor that the robot can reach, metres.
        nodes_m: (M, 2) true positions of the nodes, metres.
        radius_m: how far a node reaches, metres.

    Raises:
        ValueError: no floor.
    """
    if len(floor_m) == 0:
        raise ValueError("floor_m must hold at least one point, got none")
    if len(nodes_m) == 0:
        return 0.0
    near = 0
    for start in range(0, len(floor_m), CHUNK):
        gap = floor_m[start : start + CHUNK, None, :] - nodes_m[None, :, :]
        near += int(((gap**2).sum(axis=-1).min(axis=1) <= radius_m**2).sum())
    return near / len(floor_m)
