"""What stands in a living room: shelves, boards, a low table, a rug."""

from typing import Literal

import numpy as np

from simulator.furniture.stacks import book_pile, book_row, framed, ornament
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, ball, box, detail, label, post, table_legs


def tv_bench(
    rng: np.random.Generator,
    width_m: float = 1.8,
    depth_m: float = 0.42,
    height_m: float = 0.5,
    colour: Rgb = (206, 178, 138),
) -> Piece:
    """Low board, back at x = 0: drawers on both sides, an open middle with players and books."""
    wood = Material("wood", colour, int(rng.integers(3)))
    dark = Material("lacquer", (44, 44, 48), 7)
    half, third = width_m / 2, width_m / 6
    parts = [
        box((0.0, depth_m), (-half, half), (height_m - 0.03, height_m), wood, tile_m=0.8),
        box((0.0, depth_m), (-half, half), (0.1, 0.13), wood),
        box((0.0, 0.02), (-half, half), (0.13, height_m - 0.03), wood),
    ]
    for side in (-1, 1):
        y = sorted((side * third, side * half))
        parts.append(box((0.02, depth_m - 0.02), (y[0], y[1]), (0.13, height_m - 0.03), wood))
        for z in ((0.14, 0.29), (0.3, 0.46)):
            parts.append(box((depth_m - 0.02, depth_m), (y[0] + 0.008, y[1] - 0.008), z, wood, tile_m=0.5))
            middle = (y[0] + y[1]) / 2
            parts.append(
                detail((depth_m, depth_m + 0.012), around(middle, 0.06), (z[1] - 0.05, z[1] - 0.035), dark)
            )
        parts.extend(post(x, side * (half - 0.08), (0.0, 0.1), 0.02, dark) for x in (0.08, depth_m - 0.08))
    parts.append(detail((0.05, 0.36), (-0.2, 0.2), (0.13, 0.2), dark))
    parts.extend(book_row(rng, depth_m - 0.06, (-0.28, 0.28), (0.23, 0.46)))
    parts.append(box((0.02, depth_m - 0.02), (-third, third), (0.21, 0.23), wood))
    parts.extend(
        ornament(rng, (0.2, half - 0.12, height_m)) + book_pile(rng, (0.2, -half + 0.18, height_m), 3)
    )
    return Piece.of(*parts)


def bookshelf(
    rng: np.random.Generator,
    width_m: float = 1.8,
    height_m: float = 2.0,
    depth_m: float = 0.3,
    shelves: int = 6,
    bays: int = 2,
    colour: Rgb = (140, 98, 62),
) -> Piece:
    """Open shelves with the back at x = 0 (against a wall), front along +x."""
    wood = Material("wood", colour, int(rng.integers(3)))
    half, t = width_m / 2, 0.025
    parts: list[Part] = [box((0.0, 0.012), (-half, half), (0.0, height_m), wood)]
    bay = (width_m - t) / bays
    parts.extend(
        box((0.0, depth_m), (-half + k * bay, -half + k * bay + t), (0.0, height_m), wood)
        for k in range(bays + 1)
    )
    step = (height_m - 0.06 - t) / shelves
    for row in range(shelves + 1):
        z = 0.06 + row * step
        parts.append(box((0.0, depth_m), (-half, half), (z, z + t), wood))
    parts.append(box((0.02, depth_m - 0.02), (-half, half), (0.0, 0.06), wood))
    for row in range(shelves):
        for k in range(bays):
            side = (-half + k * bay + t + 0.01, -half + (k + 1) * bay - 0.01)
            level = (0.06 + row * step + t, 0.06 + (row + 1) * step - 0.02)
            until = side[1]
            if rng.random() < 0.4:
                until = side[0] + float(rng.uniform(0.5, 0.7)) * (side[1] - side[0])
                parts.extend(ornament(rng, (depth_m - 0.12, (until + side[1]) / 2 + 0.03, level[0])))
            parts.extend(book_row(rng, depth_m - 0.02, (side[0], until), level))
    return Piece.of(*parts)


def sideboard(
    rng: np.random.Generator,
    width_m: float = 1.4,
    depth_m: float = 0.42,
    height_m: float = 0.8,
    colour: Rgb = (156, 112, 74),
    doors: int = 3,
) -> Piece:
    """Cabinet on legs with its back at x = 0."""
    wood = Material("wood", colour, int(rng.integers(3)))
    brass = Material("metal", (190, 160, 96), 2)
    half = width_m / 2
    parts = [box((0.0, depth_m - 0.02), (-half, half), (0.12, height_m), wood, tile_m=0.8)]
    step = width_m / doors
    for k in range(doors):
        y = (-half + k * step + 0.006, -half + (k + 1) * step - 0.006)
        face = Material("wood", colour, int(rng.integers(3)))
        rows = (
            ((0.14, 0.34), (0.35, 0.55), (0.56, height_m - 0.03))
            if k == doors // 2
            else ((0.14, height_m - 0.03),)
        )
        for z in rows:
            parts.append(box((depth_m - 0.02, depth_m), y, z, face, tile_m=0.7))
            knob = (y[0] + y[1]) / 2 if len(rows) > 1 else (y[1] - 0.05 if k == 0 else y[0] + 0.05)
            parts.append(
                detail((depth_m, depth_m + 0.02), around(knob, 0.012), (z[1] - 0.12, z[1] - 0.06), brass)
            )
    parts.extend(
        post(x, y, (0.0, 0.12), 0.02, brass)
        for x in (0.06, depth_m - 0.06)
        for y in (-half + 0.06, half - 0.06)
    )
    for place in np.linspace(-half + 0.18, half - 0.18, max(2, int(width_m / 0.33))):
        choice = int(rng.integers(3))
        at = (0.2, float(place), height_m)
        if choice < 2:
            parts += (ornament, framed)[choice](rng, at)
        else:
            parts += book_pile(rng, at, int(rng.integers(2, 6)))
    return Piece.of(*parts)


def coffee_table(
    rng: np.random.Generator,
    length_m: float = 1.0,
    width_m: float = 0.55,
    height_m: float = 0.4,
    colour: Rgb = (120, 84, 54),
) -> Piece:
    """Low table, long side along y, with a shelf near the floor."""
    wood = Material("wood", colour, int(rng.integers(3)))
    hw, hl = width_m / 2, length_m / 2
    parts = [
        box((-hw, hw), (-hl, hl), (height_m - 0.04, height_m), wood, tile_m=0.8),
        box((-hw + 0.05, hw - 0.05), (-hl + 0.05, hl - 0.05), (0.1, 0.125), wood),
    ]
    parts += table_legs((hw - 0.07, hw - 0.02), (hl - 0.07, hl - 0.02), (0.0, height_m - 0.04), wood)
    parts += book_pile(rng, (0.02, -0.2, height_m), 4)
    parts += book_pile(rng, (0.0, 0.15, 0.125), 5)
    tray = Material("lacquer", (62, 70, 74), 4)
    parts.append(detail((-0.15, 0.15), (0.08, 0.42), (height_m, height_m + 0.02), tray))
    cup = Material("ceramic", (222, 208, 186), int(rng.integers(3)))
    parts.extend(
        post(x, y, (height_m + 0.02, height_m + 0.11), 0.038, cup, solid=False, tile_m=0.2)
        for x, y in ((-0.06, 0.2), (0.06, 0.31))
    )
    sugar = Material("ceramic", (104, 130, 116), 8)
    parts.append(ball((0.05, 0.17, height_m + 0.07), (0.1, 0.1, 0.1), sugar, tile_m=0.2))
    return Piece.of(*parts)


def rug(
    rng: np.random.Generator,
    length_m: float = 2.4,
    width_m: float = 1.7,
    style: Literal["persian", "kilim", "modern"] = "persian",
    colour: Rgb = (150, 46, 44),
) -> Piece:
    """Rug with its long side along y."""
    del rng
    cloth = Material(style, colour, int(1000 * length_m))
    fringe = Material("fabric", (222, 210, 184), 2)
    side, end = width_m / 2, length_m / 2
    body = label((-side, side), (-end, end), (0.0, 0.008), cloth, casts_shadow=False)
    ends = (
        detail((-side, side), y, (0.0, 0.005), fringe, tile_m=0.2, casts_shadow=False)
        for y in ((-end - 0.05, -end), (end, end + 0.05))
    )
    return Piece.of(body, *ends)
