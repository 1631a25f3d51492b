"""Places to work and to meet: desk with screens, partition between desks, meeting table."""

import numpy as np

from simulator.furniture.office import STEEL
from simulator.furniture.stacks import any_colour, book_pile
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, box, detail, label, post, rounded
from simulator.textures.noise import one_of

DARK = Material("lacquer", (40, 42, 46), 3)
WHITE = Material("lacquer", (236, 236, 232), 6)
MUGS: tuple[Rgb, ...] = ((178, 60, 52), (56, 92, 140), (226, 222, 210), (84, 116, 84))


def desk(
    rng: np.random.Generator,
    width_m: float = 1.6,
    depth_m: float = 0.8,
    height_m: float = 0.74,
    screens: int = 1,
    colour: Rgb = (214, 198, 172),
) -> Piece:
    """Desk with its back at x = 0: screens and keyboard, or else books; drawers on the right of who sits."""
    top, half = Material("wood", colour, int(rng.integers(3))), width_m / 2
    parts: list[Part] = [
        box((0.0, depth_m), (-half, half), (height_m - 0.03, height_m), top, tile_m=1.2),
        *_legs(depth_m, half, height_m),
        *_drawers(depth_m, half),
    ]
    for k in range(screens):
        parts += _screen(rng, (k - (screens - 1) / 2) * 0.6, height_m)
    if screens:
        parts += [
            detail((depth_m - 0.3, depth_m - 0.16), (-0.22, 0.22), (height_m, height_m + 0.02), DARK),
            rounded((depth_m - 0.23, 0.33, height_m + 0.015), (0.11, 0.06, 0.03), DARK, solid=False),
        ]
    else:
        parts += book_pile(rng, (depth_m * 0.4, half - 0.22, height_m), 4)
    mug = Material("ceramic", one_of(rng, MUGS), 1)
    at = float(rng.uniform(0.3, 0.42)), -half + float(rng.uniform(0.14, 0.3))
    parts.append(post(*at, (height_m, height_m + 0.1), 0.04, mug, solid=False, tile_m=0.3))
    sheet = Material("poster", (232, 232, 226), int(rng.integers(9)))
    x, y = depth_m * 0.55, -half + 0.42
    parts.append(label(around(x, 0.15), around(y, 0.105), (height_m, height_m + 0.004), sheet))
    return Piece.of(*parts)


def partition(
    rng: np.random.Generator,
    length_m: float = 3.2,
    low_m: float = 0.6,
    high_m: float = 1.15,
    colour: Rgb = (104, 120, 128),
) -> Piece:
    """Panel of cloth between desks, along y, from one height to another."""
    cloth, half = Material("fabric", colour, int(rng.integers(3))), length_m / 2
    parts: list[Part] = [
        box(around(0.0, 0.018), (-half, half), (low_m, high_m), cloth, tile_m=0.6),
        detail(around(0.0, 0.022), (-half, half), (high_m - 0.01, high_m + 0.012), STEEL),
    ]
    for side in (-1, 1):
        parts.append(detail(around(0.0, 0.022), around(side * half, 0.012), (low_m, high_m + 0.012), STEEL))
    return Piece.of(*parts)


def meeting_table(
    rng: np.random.Generator,
    length_m: float = 2.0,
    width_m: float = 1.1,
    height_m: float = 0.74,
    colour: Rgb = (186, 158, 122),
) -> Piece:
    """Table on two pedestals, long side along y, with a conference telephone, papers and cups."""
    top, hw, hl = Material("wood", colour, int(rng.integers(3))), width_m / 2, length_m / 2
    parts: list[Part] = [box((-hw, hw), (-hl, hl), (height_m - 0.035, height_m), top, tile_m=1.2)]
    for side in (-1, 1):
        y = side * (hl - 0.4)
        parts += [
            box(around(0.0, hw - 0.15), around(y, 0.06), (0.0, 0.04), STEEL),
            box(around(0.0, 0.08), around(y, 0.04), (0.04, height_m - 0.035), STEEL),
        ]
    parts.append(post(0.0, 0.0, (height_m, height_m + 0.05), 0.13, DARK, solid=False, taper=0.5))
    for k in range(4):
        x, y = (-1 if k % 2 else 1) * (hw - 0.24), (-1 if k < 2 else 1) * hl * 0.45
        sheet = Material("poster", (232, 232, 226), int(rng.integers(9)))
        parts.append(label(around(x, 0.105), around(y, 0.15), (height_m, height_m + 0.004), sheet))
        cup = Material("ceramic", any_colour(rng, 40, 230), 2)
        parts.append(post(x, y + 0.26, (height_m, height_m + 0.09), 0.035, cup, solid=False, tile_m=0.3))
    return Piece.of(*parts)


def _legs(depth: float, half: float, height: float) -> list[Part]:
    """A column on a foot at each end."""
    parts: list[Part] = []
    for side in (-1, 1):
        y = side * (half - 0.07)
        parts += [
            box((0.05, depth - 0.08), around(y, 0.035), (0.0, 0.035), STEEL),
            box(around(depth * 0.45, 0.05), around(y, 0.025), (0.035, height - 0.03), STEEL),
        ]
    return parts


def _drawers(depth: float, half: float) -> list[Part]:
    """A pedestal of three drawers under the right end, seen from where one sits."""
    y = (half - 0.5, half - 0.12)
    parts: list[Part] = [box((0.1, depth - 0.12), y, (0.04, 0.58), WHITE, tile_m=0.6)]
    for low in (0.06, 0.24, 0.42):
        parts += [
            detail((depth - 0.12, depth - 0.105), (y[0] + 0.01, y[1] - 0.01), (low, low + 0.16), WHITE),
            detail(
                (depth - 0.105, depth - 0.09),
                around((y[0] + y[1]) / 2, 0.06),
                (low + 0.1, low + 0.115),
                STEEL,
            ),
        ]
    return parts


def _screen(rng: np.random.Generator, y: float, top: float) -> list[Part]:
    """A monitor on its foot that shows a page."""
    page = Material("display", (72, 110, 150), int(rng.integers(6)), glow=0.85)
    return [
        detail((0.1, 0.3), around(y, 0.12), (top, top + 0.012), DARK),
        detail((0.13, 0.16), around(y, 0.03), (top + 0.012, top + 0.3), DARK),
        detail((0.16, 0.195), around(y, 0.28), (top + 0.11, top + 0.47), DARK),
        label((0.195, 0.197), around(y, 0.268), (top + 0.122, top + 0.458), page),
    ]
