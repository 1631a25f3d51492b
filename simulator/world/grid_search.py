"""Shortest way over free cells. Pure."""

import heapq
import math

import numpy as np
import numpy.typing as npt

Cell = tuple[int, int]
Grid = npt.NDArray[np.bool_]
STEPS = tuple((dy, dx) for dy in range(-2, 3) for dx in range(-2, 3) if math.gcd(dy, dx) == 1)


def shortest_cells(free: Grid, start: Cell, goal: Cell) -> list[Cell]:
    """A* (Hart, Nilsson and Raphael 1968) over the 16 directions of king's and knight's moves.

    Args:
        free: (rows, columns), True where one may be.
        start: first cell, (row, column).
        goal: last cell.

    Returns:
        The cells of the way with both ends; empty if there is none.
    """
    queue: list[tuple[float, Cell]] = [(0.0, start)]
    cost, parent = {start: 0.0}, {start: start}
    closed: set[Cell] = set()
    while queue:
        _, cell = heapq.heappop(queue)
        if cell == goal:
            return _trace(parent, cell)
        if cell in closed:
            continue
        closed.add(cell)
        for dy, dx in STEPS:
            if not _passable(free, cell, dy, dx):
                continue
            following = (cell[0] + dy, cell[1] + dx)
            through = cost[cell] + math.hypot(dy, dx)
            if through < cost.get(following, math.inf):
                cost[following], parent[following] = through, cell
                heapq.heappush(queue, (through + math.dist(following, goal), following))
    return []


def _trace(parent: dict[Cell, Cell], cell: Cell) -> list[Cell]:
    path = [cell]
    while parent[path[-1]] != path[-1]:
        path.append(parent[path[-1]])
    return path[::-1]


def _passable(free: Grid, cell: Cell, dy: int, dx: int) -> bool:
    """Whether the end of a move is free, and for a knight's move both cells it passes between."""
    for share in (0.5, 1.0) if max(abs(dy), abs(dx)) == 2 else (1.0,):
        row, column = cell[0] + dy * share, cell[1] + dx * share
        for r in {math.floor(row), math.ceil(row)}:
            for c in {math.floor(column), math.ceil(column)}:
                if not (0 <= r < free.shape[0] and 0 <= c < free.shape[1] and free[r, c]):
                    return False
    return True
