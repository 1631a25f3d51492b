"""Which keypoints to keep: the strongest, but spread over the picture. Pure."""

import numpy as np

from services.features.interfaces import Float32Array, FloatArray, IndexArray


def spread(
    lonlat_rad: FloatArray, scores: Float32Array, count: int, cells: tuple[int, int], max_lat_rad: float
) -> IndexArray:
    """Take the best of every cell of a grid, then every second best, and so on, until `count` are taken.

    One bookshelf would otherwise take all keypoints and leave nothing in the other directions.

    Args:
        lonlat_rad: (N, 2) longitude, latitude, radians.
        scores: (N,) larger is better.
        count: most to take.
        cells: columns over the full turn and rows between -max_lat_rad and +max_lat_rad.
        max_lat_rad: latitude the grid reaches to.

    Returns:
        Indices, strongest first; equal scores in order of position.
    """
    columns, rows = cells
    lon, lat = lonlat_rad[:, 0], lonlat_rad[:, 1]
    column = np.clip(np.floor((lon + np.pi) / (2.0 * np.pi) * columns), 0, columns - 1).astype(np.intp)
    row = np.clip(np.floor((lat / max_lat_rad + 1.0) / 2.0 * rows), 0, rows - 1).astype(np.intp)
    strongest = np.lexsort((lat, lon, -scores))
    if len(strongest) > count:
        cell = (row * columns + column)[strongest]
        by_cell = np.argsort(cell, kind="stable")
        first = np.searchsorted(cell[by_cell], cell[by_cell], side="left")
        rank = np.empty(len(cell), dtype=np.intp)
        rank[by_cell] = np.arange(len(cell)) - first
        taken = np.argsort(rank, kind="stable")[:count]
        strongest = strongest[np.sort(taken)]
    return strongest
