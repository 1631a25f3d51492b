"""Flat things on walls: thermostat, light switch, fuse box, mirror."""

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, detail, label


def thermostat(rng: np.random.Generator, size_m: float = 0.14) -> Piece:
    """Wall device with a display; the item's height is its centre."""
    half = size_m / 2
    return Piece(
        (
            label(
                (0.0, 0.025),
                (-half, half),
                (-half, half),
                Material("panel", (226, 226, 222), int(rng.integers(100))),
            ),
        )
    )


def switch(rng: np.random.Generator) -> Piece:
    """Light switch."""
    del rng
    white = Material("lacquer", (240, 240, 236), 6)
    return Piece(
        (
            detail((0.0, 0.008), (-0.045, 0.045), (-0.045, 0.045), white),
            detail((0.008, 0.014), (-0.028, 0.028), (-0.03, 0.03), Material("lacquer", (216, 216, 210), 7)),
        )
    )


def fuse_box(rng: np.random.Generator, width_m: float = 0.36, height_m: float = 0.5) -> Piece:
    """Metal cabinet flush with the wall, with a label."""
    steel = Material("lacquer", (204, 206, 204), int(rng.integers(100)))
    half, tall = width_m / 2, height_m / 2
    return Piece(
        (
            detail((0.0, 0.03), (-half, half), (-tall, tall), steel, tile_m=0.5),
            label(
                (0.03, 0.032),
                (-half + 0.03, half - 0.1),
                (tall - 0.16, tall - 0.05),
                Material("poster", (0, 0, 0), 7),
            ),
            detail(
                (0.03, 0.045), (half - 0.06, half - 0.04), (-0.05, 0.05), Material("metal", (90, 90, 94), 1)
            ),
        )
    )


def mirror(
    rng: np.random.Generator, width_m: float = 0.5, height_m: float = 1.1, frame: Rgb = (176, 142, 84)
) -> Piece:
    """Mirror with a painted reflection."""
    pane, edge = Material("mirror", (200, 208, 202), int(rng.integers(100))), Material("metal", frame, 5)
    half, tall = width_m / 2, height_m / 2
    return Piece(
        (
            detail((0.0, 0.02), (-half, half), (-tall, tall), edge),
            label((0.02, 0.022), (-half + 0.03, half - 0.03), (-tall + 0.03, tall - 0.03), pane),
        )
    )
