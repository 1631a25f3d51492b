"""What screens show: a switched-off television, the windows of somebody at work. RGB."""

import numpy as np

from simulator.textures.noise import (
    FloatArray,
    Image,
    Rgb,
    block,
    finish,
    flat,
    noised,
    one_of,
    smooth,
    write,
)

BARS: tuple[Rgb, ...] = ((44, 92, 160), (36, 120, 92), (196, 92, 48), (110, 84, 150), (120, 126, 134))
INK = (64.0, 68.0, 76.0)


def screen(rng: np.random.Generator, colour: Rgb) -> Image:
    """Switched-off television with a soft reflection of the room."""
    height, width = 288, 512
    image = noised(flat(height, width, colour), rng, 2.0, 0.35)
    for x, y, half in ((110, 60, 46), (380, 80, 34)):
        block(image, (x - half, y - 26), (x + half, y + 60), (88.0, 96.0, 108.0))
    return finish(smooth(image, 6.0))


def display(rng: np.random.Generator, colour: Rgb) -> Image:
    """A lit screen: a page of text and a window over it with a table or a chart, on the colour's ground."""
    height, width = 320, 512
    image = flat(height, width, colour)
    block(image, (0, height - 18), (width, height), (40.0, 44.0, 52.0))
    _window(rng, image, (14, 12), (330, 286))
    for line in range(17):
        y, indent = 52 + 13 * line, int(rng.choice([0, 0, 14, 28]))
        if rng.random() < 0.85:
            block(image, (28 + indent, y), (28 + indent + int(rng.integers(60, 250)), y + 4), INK)
    _window(rng, image, (230, 70), (500, 262))
    if rng.random() < 0.5:
        for row in range(9):
            for column in range(5):
                x, y = 240 + 51 * column, 104 + 17 * row
                block(image, (x, y), (x + int(rng.integers(14, 42)), y + 5), INK)
    else:
        for k in range(10):
            ink = tuple(float(c) for c in one_of(rng, BARS))
            block(image, (244 + 25 * k, 250 - int(rng.integers(15, 140))), (262 + 25 * k, 250), ink)
    return finish(image)


def _window(rng: np.random.Generator, image: FloatArray, low: tuple[int, int], high: tuple[int, int]) -> None:
    """A white window with a frame and a coloured bar with its title."""
    block(image, (low[0] - 2, low[1] - 2), (high[0] + 2, high[1] + 2), (96.0, 100.0, 108.0))
    block(image, low, high, (246.0, 246.0, 244.0))
    block(image, low, (high[0], low[1] + 22), tuple(float(c) for c in one_of(rng, BARS)))
    title = "".join(chr(int(c)) for c in rng.integers(65, 91, int(rng.integers(5, 9))))
    write(image, title, (low[0] + 8, low[1] + 16), 0.5, (244.0, 244.0, 240.0), 1)
