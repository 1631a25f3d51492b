"""Materials of streets, gardens and houses from outside. RGB, tileable."""

import cv2
import numpy as np

from simulator.textures.noise import (
    Image,
    Rgb,
    blob,
    block,
    disc,
    finish,
    flat,
    modulate,
    noised,
    oval,
    scaled,
    smooth,
    spectral_noise,
    stroke,
    vary,
)


def asphalt(rng: np.random.Generator, colour: Rgb) -> Image:
    """Worn asphalt: grit, mended patches, cracks and oil stains."""
    size = 1024
    image = noised(flat(size, size, colour), rng, 1.7, 0.05)
    image = noised(image, rng, 0.4, 0.07)
    tone = np.zeros((size, size), np.float32)
    for _ in range(9):
        x, y = (int(v) for v in rng.integers(80, size - 200, 2))
        w, h = (int(v) for v in rng.integers(40, 180, 2))
        block(tone, (x, y), (x + w, y + h), float(rng.uniform(-1.0, 0.5)))
    for _ in range(16):
        cv2.fillPoly(tone, [blob(rng, tuple(rng.uniform(60, size - 60, 2)), rng.uniform(8, 40))], -1.0)
    image = modulate(image, smooth(tone, 1.2), 0.13)
    cracks = np.zeros((size, size), np.float32)
    for _ in range(22):
        point, angle = rng.uniform(0, size, 2), rng.uniform(0, 2 * np.pi)
        for _ in range(int(rng.integers(10, 40))):
            angle += rng.normal(0.0, 0.5)
            following = point + 12 * np.array([np.cos(angle), np.sin(angle)])
            stroke(cracks, point.astype(int).tolist(), following.astype(int).tolist(), 1.0, 1)
            point = following
    return finish(modulate(image, -cracks, 0.4))


def grass(rng: np.random.Generator, colour: Rgb) -> Image:
    """Lawn: blades, worn and lush patches, some clover and daisies."""
    size = 1024
    image = noised(flat(size, size, colour), rng, 1.5, 0.13)
    blades = spectral_noise(rng, size, size, 0.5, stretch=0.2)
    image = modulate(image, blades, 0.15)
    dry = smooth((spectral_noise(rng, size, size, 2.0) > 1.1).astype(np.float32), 5.0)[..., None]
    image = image * (1.0 - 0.4 * dry) + np.array((158, 142, 92), np.float32) * 0.4 * dry
    for _ in range(260):
        x, y = (int(v) for v in rng.integers(3, size - 3, 2))
        ink = (238.0, 236.0, 226.0) if rng.random() < 0.6 else (226.0, 196.0, 60.0)
        disc(image, (x, y), int(rng.integers(2, 4)), ink)
    return finish(image)


def paving(rng: np.random.Generator, colour: Rgb) -> Image:
    """Paving stones in courses, each with its own tone."""
    return _courses(rng, colour, rows=12, per_row=6, joint=(98, 92, 84), spread=0.16)


def bricks(rng: np.random.Generator, colour: Rgb) -> Image:
    """Brickwork with mortar."""
    return _courses(rng, colour, rows=24, per_row=8, joint=(176, 168, 156), spread=0.2)


def roof_tiles(rng: np.random.Generator, colour: Rgb) -> Image:
    """Rows of clay tiles that overlap: each row is darker under the one above."""
    size, rows = 1024, 20
    image = np.asarray(_courses(rng, colour, rows, 16, (70, 48, 40), 0.22), np.float32)
    shade = 1.0 - 0.35 * ((np.arange(size) % (size // rows)) < size // rows // 4)
    moss = np.maximum(spectral_noise(rng, size, size, 1.9) - 1.0, 0.0)
    return finish(modulate(image * shade[:, None, None].astype(np.float32), -moss, 0.25))


def concrete(rng: np.random.Generator, colour: Rgb) -> Image:
    """Cast concrete: clouds, pores, streaks."""
    size = 512
    image = noised(flat(size, size, colour), rng, 1.6, 0.07)
    image = noised(image, rng, 1.2, 0.05, 0.05)
    pores = (rng.random((size, size)) > 0.997).astype(np.float32)
    return finish(modulate(image, -cv2.dilate(pores, np.ones((3, 3), np.uint8)), 0.3))


def planks(rng: np.random.Generator, colour: Rgb) -> Image:
    """Weathered boards along the columns."""
    size, count = 512, 10
    image = noised(flat(size, size, colour), rng, 0.9, 0.13, 0.05)
    width = size // count
    for k in range(count):
        image[:, k * width : (k + 1) * width] *= float(rng.uniform(0.82, 1.12))
        image[:, k * width : k * width + 3] *= 0.45
    return finish(noised(image, rng, 1.7, 0.06))


def bark(rng: np.random.Generator, colour: Rgb) -> Image:
    """Furrowed bark along the columns."""
    size = 256
    furrows = spectral_noise(rng, size, size, 1.1, stretch=0.12)
    return finish(modulate(flat(size, size, colour), np.minimum(furrows, 0.6), 0.28))


def foliage(rng: np.random.Generator, colour: Rgb) -> Image:
    """Dense leaves in light and shade, for crowns and hedges."""
    size = 512
    image = flat(size, size, tuple(int(0.42 * c) for c in colour))  # type: ignore[arg-type]
    for layer in range(3):
        for _ in range(700):
            x, y = (int(v) for v in rng.integers(0, size, 2))
            shade = (0.55 + 0.22 * layer) * rng.uniform(0.8, 1.25)
            tone = scaled(vary(rng, colour, 0.12), shade)
            axes, angle = (int(rng.integers(5, 12)), int(rng.integers(3, 6))), float(rng.uniform(0, 180))
            for dx in (-size, 0, size):
                for dy in (-size, 0, size):
                    if -20 < x + dx < size + 20 and -20 < y + dy < size + 20:
                        oval(image, (x + dx, y + dy), axes, angle, tone)
    return finish(noised(image, rng, 1.9, 0.08))


def _courses(
    rng: np.random.Generator, colour: Rgb, rows: int, per_row: int, joint: Rgb, spread: float
) -> Image:
    """Stones in rows, every other row shifted by half a stone."""
    size = 1024
    image = flat(size, size, joint)
    rough = spectral_noise(rng, size, size, 1.1)
    edges = np.linspace(0, size, rows + 1).astype(int)
    step = size // per_row
    for row in range(rows):
        top, bottom = edges[row] + 2, edges[row + 1] - 2
        for k in range(per_row):
            columns = (np.arange(3, step - 3) + k * step + (row % 2) * step // 2) % size
            tone = np.array(vary(rng, colour, spread), np.float32)
            image[top:bottom, columns] = tone * (1.0 + 0.07 * rough[top:bottom, columns])[..., None]
    return finish(image)
