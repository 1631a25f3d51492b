"""Furniture materials: wood, fabric, leather, metal, ceramics, leaves, lacquer. RGB, tileable."""

import cv2
import numpy as np

from simulator.textures.noise import (
    Image,
    Rgb,
    block,
    finish,
    flat,
    modulate,
    noised,
    one_of,
    oval,
    scaled,
    smooth,
    spectral_noise,
    stroke,
)


def wood(rng: np.random.Generator, colour: Rgb) -> Image:
    """Veneer: long grain along the rows with growth rings."""
    size = 512
    warp = spectral_noise(rng, size, size, 1.8, stretch=8.33)
    rows = np.arange(size, dtype=np.float32)[:, None] / size
    rings = np.sin(2 * np.pi * (rows * 14.0) + 2.2 * warp)
    image = modulate(flat(size, size, colour), rings, 0.07)
    image = noised(image, rng, 0.7, 0.07, 33.3)
    return finish(modulate(image, warp, 0.06))


def fabric(rng: np.random.Generator, colour: Rgb) -> Image:
    """Woven cloth with slubs and worn patches."""
    size = 512
    grid = np.arange(size, dtype=np.float32)
    weave = np.sin(grid[:, None] * np.pi / 2.0) * np.sin(grid[None, :] * np.pi / 2.0)
    image = modulate(flat(size, size, colour), weave, 0.05)
    image = noised(image, rng, 0.6, 0.08)
    image = noised(image, rng, 0.9, 0.05, 20)
    return finish(noised(image, rng, 1.8, 0.06))


def leather(rng: np.random.Generator, colour: Rgb) -> Image:
    """Grained leather with creases."""
    size = 512
    cells = smooth(rng.standard_normal((size, size)).astype(np.float32), 2.2)
    image = modulate(flat(size, size, colour), cells / cells.std(), 0.07)
    crease = np.exp(-((spectral_noise(rng, size, size, 1.6) / 0.05) ** 2))
    return finish(noised(modulate(image, -crease, 0.18), rng, 1.9, 0.08))


def pattern_cloth(rng: np.random.Generator, colour: Rgb) -> Image:
    """Printed cloth: leaves and dots scattered over a ground, for cushions and curtains."""
    size = 512
    image = flat(size, size, colour)
    inks = [tuple(float(v) for v in rng.integers(30, 235, 3)) for _ in range(4)]
    for _ in range(90):
        x, y = (int(v) for v in rng.integers(0, size, 2))
        axes = (int(rng.integers(8, 30)), int(rng.integers(3, 9)))
        angle, ink = float(rng.uniform(0, 360)), one_of(rng, inks)
        for dx in (-size, 0, size):
            for dy in (-size, 0, size):
                oval(image, (x + dx, y + dy), axes, angle, ink)
    return finish(noised(image, rng, 0.5, 0.06))


def metal(rng: np.random.Generator, colour: Rgb) -> Image:
    """Brushed metal."""
    image = noised(flat(256, 256, colour), rng, 0.5, 0.05, 50)
    return finish(noised(image, rng, 1.8, 0.07))


def lacquer(rng: np.random.Generator, colour: Rgb) -> Image:
    """Painted furniture: nearly even, a few nicks."""
    size = 256
    image = noised(flat(size, size, colour), rng, 1.6, 0.02)
    for _ in range(9):
        x, y = (int(v) for v in rng.integers(4, size - 4, 2))
        tone = tuple(float(c * rng.uniform(0.8, 0.95)) for c in colour)
        oval(image, (x, y), (int(rng.integers(1, 5)), 1), float(rng.uniform(0, 180)), tone)
    return finish(image)


def ceramic(rng: np.random.Generator, colour: Rgb) -> Image:
    """Glazed pottery with speckles and bands."""
    size = 256
    image = noised(flat(size, size, colour), rng, 1.4, 0.07)
    for band in rng.integers(20, size - 20, 3):
        cv2.line(image, (0, int(band)), (size, int(band)), scaled(colour, 0.55), int(rng.integers(2, 7)))
    speckle = (rng.random((size, size)) > 0.995).astype(np.float32)
    return finish(modulate(image, -cv2.dilate(speckle, np.ones((2, 2), np.uint8)), 0.5))


def leaf(rng: np.random.Generator, colour: Rgb) -> Image:
    """Leaf surface with midrib and veins, midrib along the columns."""
    size = 256
    image = noised(flat(size, size, colour), rng, 1.3, 0.13)
    vein = tuple(float(min(255, c * 1.45 + 18)) for c in colour)
    stroke(image, (size // 2, 0), (size // 2, size), vein, 6)
    for y in range(10, size, 26):
        stroke(image, (size // 2, y + 24), (0, y - 30), vein, 2)
        stroke(image, (size // 2, y + 24), (size, y - 30), vein, 2)
    return finish(image)


def wicker(rng: np.random.Generator, colour: Rgb) -> Image:
    """Basket weave."""
    size, step = 256, 16
    image = flat(size, size, tuple(int(0.5 * c) for c in colour))  # type: ignore[arg-type]
    for i in range(size // step):
        for j in range(size // step):
            shade = float(rng.uniform(0.8, 1.1))
            tone = scaled(colour, shade)
            y, x = i * step, j * step
            rect = (
                ((x, y + 3), (x + step - 1, y + step - 4))
                if (i + j) % 2
                else ((x + 3, y), (x + step - 4, y + step - 1))
            )
            block(image, rect[0], rect[1], tone)
    return finish(noised(image, rng, 0.7, 0.08))


def glow(rng: np.random.Generator, colour: Rgb) -> Image:
    """Lit lampshade: even, slightly cloudy."""
    return finish(noised(flat(128, 128, colour), rng, 1.8, 0.02))
