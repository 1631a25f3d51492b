"""Building surfaces: plaster, ceiling paint and panels, floor boards, tiles, carpet. RGB, tileable."""

import numpy as np

from simulator.textures.noise import (
    FloatArray,
    Image,
    Rgb,
    disc,
    finish,
    flat,
    modulate,
    noised,
    oval,
    smooth,
    spectral_noise,
    stroke,
    vary,
)


def plaster(rng: np.random.Generator, colour: Rgb) -> Image:
    """Rolled wall paint: broad uneven tone, roller grain, a few faint scuffs and filled holes."""
    size = 1024
    image = noised(flat(size, size, colour), rng, 1.6, 0.018)
    image = noised(image, rng, 0.6, 0.014)
    marks = np.zeros((size, size), np.float32)
    for _ in range(70):
        x, y = rng.integers(0, size, 2)
        angle, length = rng.uniform(0, np.pi), rng.uniform(8, 60)
        end = (int(x + length * np.cos(angle)), int(y + length * np.sin(angle)))
        stroke(marks, (int(x), int(y)), end, float(rng.uniform(-1.0, 0.6)), int(rng.integers(1, 4)))
    for _ in range(60):
        x, y = rng.integers(0, size, 2)
        disc(marks, (int(x), int(y)), int(rng.integers(2, 9)), float(rng.uniform(-1.0, 1.0)))
    return finish(modulate(image, smooth(marks, 1.5), 0.055))


def ceiling(rng: np.random.Generator, colour: Rgb) -> Image:
    """Ceiling paint: nearly even."""
    image = noised(flat(512, 512, colour), rng, 1.5, 0.012)
    return finish(noised(image, rng, 0.3, 0.012))


def boards(rng: np.random.Generator, colour: Rgb) -> Image:
    """Floor boards along x: each with its own tone, grain, knots and joints."""
    size, rows = 2048, 32
    image = flat(size, size, colour)
    grain = spectral_noise(rng, size, size, 1.0, stretch=16.7)
    broad = spectral_noise(rng, size, size, 1.5, stretch=6.67)
    height = size // rows
    for row in range(rows):
        top = row * height
        cuts = np.sort(rng.integers(0, size, int(rng.integers(3, 6))))
        for start, end in zip(cuts, np.append(cuts[1:], cuts[0] + size), strict=True):
            columns = np.arange(start, end) % size
            shift = int(rng.integers(0, size))
            strip = np.roll(grain[top : top + height], shift, axis=1)[:, columns] * 0.09
            strip = strip + np.roll(broad[top : top + height], shift, axis=1)[:, columns] * 0.05
            tone = np.array(vary(rng, colour, 0.16), np.float32)
            image[top : top + height, columns] = tone * (1.0 + strip[..., None])
            image[top : top + height, int(start) % size] *= 0.45
        image[top] *= 0.5
        image[top + height - 1] *= 0.72
    _knots(rng, image, 90)
    return finish(image)


def _knots(rng: np.random.Generator, image: FloatArray, count: int) -> None:
    size = image.shape[0]
    shade = np.ones((size, size), np.float32)
    for _ in range(count):
        x, y = (int(v) for v in rng.integers(20, size - 20, 2))
        axes = (int(rng.integers(6, 16)), int(rng.integers(3, 7)))
        oval(shade, (x, y), (axes[0] * 2, axes[1] * 2), 0, 0.82)
        oval(shade, (x, y), axes, 0, float(rng.uniform(0.45, 0.65)))
    image *= smooth(shade, 1.6)[..., None]


def tiles(rng: np.random.Generator, colour: Rgb) -> Image:
    """Stone tiles, 8 x 8 in the square, cloudy and veined, with grout."""
    size, count = 1024, 8
    image = flat(size, size, (150, 145, 138))
    cloud = spectral_noise(rng, size, size, 1.7)
    fine = spectral_noise(rng, size, size, 0.8)
    step = size // count
    for i in range(count):
        for j in range(count):
            ys, xs = slice(i * step + 2, (i + 1) * step - 2), slice(j * step + 2, (j + 1) * step - 2)
            dy, dx = (int(v) for v in rng.integers(0, size - step, 2))
            vein = cloud[dy : dy + step - 4, dx : dx + step - 4]
            tone = np.array(vary(rng, colour, 0.07), np.float32)
            ridge = np.exp(-((vein / 0.07) ** 2))
            image[ys, xs] = tone * (1.0 + 0.05 * vein - 0.13 * ridge + 0.025 * fine[ys, xs])[..., None]
    return finish(image)


def carpet_tile(rng: np.random.Generator, colour: Rgb) -> Image:
    """One carpet tile: loops in rows, flecks of yarn, a darker joint round it. All tiles are alike."""
    size = 256
    loops = np.sin(np.arange(size, dtype=np.float32) * np.pi / 4.0)
    image = modulate(flat(size, size, colour), np.broadcast_to(loops[:, None], (size, size)), 0.03)
    flecks = np.zeros((size, size), np.float32)
    for _ in range(150):
        x, y = (int(v) for v in rng.integers(4, size - 12, 2))
        stroke(flecks, (x, y), (x + int(rng.integers(3, 9)), y), float(rng.uniform(-1.0, 1.0)), 3)
    image = noised(modulate(image, smooth(flecks, 0.8), 0.22), rng, 0.5, 0.05)
    image[[0, -1]] *= 0.72
    image[:, [0, -1]] *= 0.72
    return finish(image)


def ceiling_panel(rng: np.random.Generator, colour: Rgb) -> Image:
    """One mineral fibre panel with its pores, hung in a white grid. All panels are alike."""
    size, rail = 256, 5
    image = noised(flat(size, size, colour), rng, 1.0, 0.012)
    pores = np.zeros((size, size), np.float32)
    for _ in range(320):
        x, y = (int(v) for v in rng.integers(rail, size - rail, 2))
        disc(pores, (x, y), int(rng.integers(1, 4)), float(rng.uniform(0.3, 1.0)))
    image = modulate(image, -smooth(pores, 0.7), 0.2)
    for edge in (slice(0, rail), slice(size - rail, size)):
        image[edge], image[:, edge] = (246.0, 246.0, 244.0), (246.0, 246.0, 244.0)
    for line in (rail, size - rail - 1):
        image[line, rail:-rail] *= 0.8
        image[rail:-rail, line] *= 0.8
    return finish(image)
