"""Small things that stand on furniture: piles of books, vases, framed photographs, boxes."""

from dataclasses import replace

import numpy as np

from simulator.scene.parts import Material, Part, Rgb, Vec3
from simulator.scene.shapes import around, ball, detail, label, post
from simulator.textures.noise import one_of
from simulator.textures.objects import SPINES

COVERS: tuple[Rgb, ...] = (
    (120, 40, 40),
    (40, 66, 104),
    (62, 96, 70),
    (206, 180, 126),
    (228, 222, 206),
    (188, 100, 52),
)


def any_colour(rng: np.random.Generator, low: int, high: int) -> Rgb:
    """A colour between two levels, one of a few: materials are shared, and the renderer's table is short."""
    red, green, blue = (int(v) for v in rng.integers(low, high, 3) // 32 * 32)
    return red, green, blue


def shade_of(rng: np.random.Generator, colour: Rgb, step: int) -> Rgb:
    """The colour up to 15 % darker or lighter in each channel, rounded down to multiples of `step`."""
    red, green, blue = (int(c * rng.uniform(0.85, 1.15)) // step * step for c in colour)
    return red, green, blue


def book_pile(rng: np.random.Generator, at: Vec3, count: int) -> list[Part]:
    """Books lying on one another."""
    parts, z = [], at[2]
    for _ in range(count):
        depth, width, thick = rng.uniform(0.15, 0.21), rng.uniform(0.21, 0.28), rng.uniform(0.015, 0.04)
        cover = Material(
            "poster" if rng.random() < 0.5 else "fabric", one_of(rng, COVERS), int(rng.integers(4))
        )
        book = label((-depth / 2, depth / 2), (-width / 2, width / 2), (0.0, thick), cover)
        parts.append(_at(book, (at[0], at[1], z), float(rng.normal(0, 0.2))))
        z += thick
    return parts


def book_row(
    rng: np.random.Generator, front_x: float, y: tuple[float, float], z: tuple[float, float]
) -> list[Part]:
    """Books standing side by side between two y, spines at about `front_x`, no higher than z[1]."""
    spines = Material("books", (0, 0, 0), int(rng.integers(6)))
    parts, at = [], y[0]
    while at < y[1] - 0.05:
        thick, tall = float(rng.uniform(0.018, 0.05)), float(rng.uniform(0.68, 0.98)) * (z[1] - z[0])
        if at + thick > y[1]:
            break
        if rng.random() < 0.035:
            at += float(rng.uniform(0.03, 0.09))
            continue
        depth, inset, k = 0.17, float(rng.uniform(0.0, 0.025)), int(rng.integers(SPINES))
        x, uv = (front_x - inset - depth, front_x - inset), (k / SPINES, 0.0, (k + 1) / SPINES, 1.0)
        parts.append(label(x, (at, at + thick), (z[0], z[0] + tall), spines, uv=uv))
        at += thick + 0.001
    return parts


def ornament(rng: np.random.Generator, at: Vec3) -> list[Part]:
    """A vase, a box, a bowl or a small framed photograph."""
    seed = int(rng.integers(3))
    colour: Rgb = one_of(rng, ((196, 120, 86), (70, 104, 142), (222, 214, 196), (110, 130, 104)))
    kind, glazed = int(rng.integers(4)), Material("ceramic", colour, seed)
    x, y, z = at
    if kind == 0:
        tall = float(rng.uniform(0.14, 0.3))
        return [post(x, y, (z, z + tall), 0.055, glazed, solid=False, taper=0.6, tile_m=0.3)]
    if kind == 1:
        wicker = Material("wicker", (176, 142, 96), seed)
        return [detail(around(x, 0.08), around(y, 0.11), (z, z + 0.14), wicker, tile_m=0.25)]
    if kind == 2:
        return [ball((x, y, z + 0.08), (0.17, 0.17, 0.16), glazed, tile_m=0.3)]
    return framed(rng, at)


def framed(rng: np.random.Generator, at: Vec3) -> list[Part]:
    """A framed photograph that stands on its edge, facing +x."""
    x, y, z = at
    frame = Material("wood", (70, 52, 40), 6)
    photo = Material(one_of(rng, ("street", "landscape", "still_life")), (0, 0, 0), int(rng.integers(6)))
    return [
        detail(around(x, 0.01), around(y, 0.1), (z, z + 0.17), frame),
        label((x + 0.01, x + 0.013), around(y, 0.085), (z + 0.015, z + 0.155), photo),
    ]


def _at(part: Part, at: Vec3, yaw: float) -> Part:
    centre = (part.centre_m[0] + at[0], part.centre_m[1] + at[1], part.centre_m[2] + at[2])
    return replace(part, centre_m=centre, yaw_rad=yaw)
