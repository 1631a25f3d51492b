"""What hangs on walls: pictures, mirror, clock, television, radiator, small devices."""

from typing import Literal

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb
from simulator.scene.shapes import box, detail, label


def picture(
    rng: np.random.Generator,
    width_m: float = 0.7,
    height_m: float = 0.55,
    style: Literal["landscape", "abstract", "still_life", "street", "poster"] = "landscape",
    frame: Rgb = (60, 44, 34),
    mount_m: float = 0.04,
    variant: int = 0,
) -> Piece:
    """Framed picture facing +x, its centre at the item's height; `variant` picks a picture of the style."""
    wood = Material("wood", frame, 4)
    card = Material("lacquer", (238, 234, 224), 3)
    canvas = Material(style, (200, 180, 150), variant if variant else int(rng.integers(100_000)))
    half, tall, edge = width_m / 2, height_m / 2, 0.025
    parts = [detail((0.0, 0.012), (-half, half), (-tall, tall), card)]
    for sign in (-1, 1):
        parts += [
            detail((0.0, 0.03), (sign * half, sign * (half - edge)), (-tall, tall), wood),
            detail((0.0, 0.03), (-half, half), (sign * tall, sign * (tall - edge)), wood),
        ]
    inset = edge + mount_m
    parts.append(label((0.012, 0.015), (-half + inset, half - inset), (-tall + inset, tall - inset), canvas))
    return Piece.of(*parts)


def thermostat(rng: np.random.Generator, size_m: float = 0.14) -> Piece:
    """Wall device with a display; the item's height is its centre."""
    half, panel = size_m / 2, Material("panel", (226, 226, 222), int(rng.integers(100)))
    return Piece.of(label((0.0, 0.025), (-half, half), (-half, half), panel))


def switch(rng: np.random.Generator) -> Piece:
    """Light switch."""
    del rng
    white = Material("lacquer", (240, 240, 236), 6)
    return Piece.of(
        detail((0.0, 0.008), (-0.045, 0.045), (-0.045, 0.045), white),
        detail((0.008, 0.014), (-0.028, 0.028), (-0.03, 0.03), Material("lacquer", (216, 216, 210), 7)),
    )


def fuse_box(rng: np.random.Generator, width_m: float = 0.36, height_m: float = 0.5) -> Piece:
    """Metal cabinet flush with the wall, with a label."""
    steel = Material("lacquer", (204, 206, 204), int(rng.integers(100)))
    text, lock = Material("poster", (0, 0, 0), 7), Material("metal", (90, 90, 94), 1)
    half, tall = width_m / 2, height_m / 2
    return Piece.of(
        detail((0.0, 0.03), (-half, half), (-tall, tall), steel, tile_m=0.5),
        label((0.03, 0.032), (-half + 0.03, half - 0.1), (tall - 0.16, tall - 0.05), text),
        detail((0.03, 0.045), (half - 0.06, half - 0.04), (-0.05, 0.05), lock),
    )


def mirror(
    rng: np.random.Generator, width_m: float = 0.5, height_m: float = 1.1, frame: Rgb = (176, 142, 84)
) -> Piece:
    """Mirror with a painted reflection."""
    pane, edge = Material("mirror", (200, 208, 202), int(rng.integers(100))), Material("metal", frame, 5)
    half, tall = width_m / 2, height_m / 2
    return Piece.of(
        detail((0.0, 0.02), (-half, half), (-tall, tall), edge),
        label((0.02, 0.022), (-half + 0.03, half - 0.03), (-tall + 0.03, tall - 0.03), pane),
    )


def clock(rng: np.random.Generator, size_m: float = 0.34, colour: Rgb = (240, 236, 224)) -> Piece:
    """Square wall clock facing +x, centre at the item's height."""
    half, face = size_m / 2, Material("clock", colour, int(rng.integers(1000)))
    return Piece.of(
        detail((0.0, 0.03), (-half, half), (-half, half), Material("wood", (70, 50, 36), 2)),
        label((0.03, 0.032), (-half + 0.02, half - 0.02), (-half + 0.02, half - 0.02), face),
    )


def television(rng: np.random.Generator, width_m: float = 1.25, height_m: float = 0.72) -> Piece:
    """Flat screen facing +x, back at x = 0, lower edge at z = 0 of the item."""
    case, screen = (
        Material("lacquer", (24, 24, 26), 9),
        Material("screen", (34, 36, 42), int(rng.integers(100))),
    )
    half = width_m / 2
    return Piece.of(
        box((0.0, 0.05), (-half, half), (0.0, height_m), case),
        label((0.05, 0.052), (-half + 0.012, half - 0.012), (0.02, height_m - 0.012), screen),
        detail((-0.1, 0.14), (-0.16, 0.16), (-0.06, -0.045), case),
        detail((0.0, 0.04), (-0.04, 0.04), (-0.06, 0.0), case),
    )


def radiator(rng: np.random.Generator, width_m: float = 0.9, height_m: float = 0.6) -> Piece:
    """Radiator on a wall at x = 0, facing +x."""
    del rng
    face, steel = Material("radiator", (236, 236, 232), 1), Material("metal", (190, 190, 190), 3)
    half = width_m / 2
    return Piece.of(
        box((0.03, 0.1), (-half, half), (0.14, 0.14 + height_m), face, tile_m=None),
        detail((0.05, 0.08), (half, half + 0.06), (0.16, 0.2), steel),
        detail((0.05, 0.08), (half + 0.04, half + 0.06), (0.0, 0.2), steel),
    )
