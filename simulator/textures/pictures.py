"""Pictures on walls: painted landscapes, abstract compositions, still lives, photographs, posters. RGB."""

import cv2
import numpy as np

from simulator.textures.noise import (
    FloatArray,
    Image,
    Rgb,
    blob,
    block,
    disc,
    fill,
    finish,
    flat,
    ink_near,
    noised,
    one_of,
    scaled,
    spectral_noise,
    stroke,
    vary,
    write,
)

HEIGHT, WIDTH = 512, 640
PALETTES: tuple[tuple[Rgb, ...], ...] = (
    ((198, 84, 56), (236, 190, 98), (38, 78, 102), (240, 232, 214), (110, 150, 140)),
    ((52, 60, 92), (196, 152, 96), (226, 218, 198), (140, 58, 52), (88, 120, 98)),
    ((240, 202, 190), (88, 104, 150), (40, 40, 52), (206, 120, 96), (250, 244, 230)),
    ((30, 92, 90), (226, 168, 60), (244, 238, 220), (170, 70, 40), (84, 56, 70)),
)


def landscape(rng: np.random.Generator, colour: Rgb) -> Image:
    """Sky, ranges of hills, water or fields, trees."""
    rows = np.linspace(0, 1, HEIGHT, dtype=np.float32)[:, None, None]
    sky = np.array(vary(rng, (120, 168, 214), 0.25), np.float32)
    low = np.array(vary(rng, (244, 214, 178), 0.12), np.float32)
    image = np.broadcast_to(sky * (1 - rows) + low * rows, (HEIGHT, WIDTH, 3)).copy()
    clouds = np.clip(spectral_noise(rng, HEIGHT, WIDTH, 1.5, stretch=2), 0, 2)[..., None] * 0.28
    image = image * (1 - clouds) + 250.0 * clouds
    base = rng.uniform(0.35, 0.5) * HEIGHT
    for layer in range(5):
        ridge = base + 18 * layer**1.5 + spectral_noise(rng, 4, WIDTH, 1.6)[0] * (26 - 3 * layer)
        tone = np.array(vary(rng, (92 - 8 * layer, 118 - 10 * layer, 96 - 14 * layer), 0.28), np.float32)
        below = np.arange(HEIGHT)[:, None] > ridge[None, :]
        texture = 1.0 + 0.13 * spectral_noise(rng, HEIGHT, WIDTH, 0.9)
        image = np.where(below[..., None], tone * texture[..., None], image)
        base += rng.uniform(24, 52)
    _trees(rng, image, int(rng.integers(6, 16)))
    return _painted(rng, image, colour)


def _trees(rng: np.random.Generator, image: FloatArray, count: int) -> None:
    for y in np.sort(rng.uniform(0.58, 0.98, count)) * HEIGHT:
        x, size = float(rng.uniform(0, WIDTH)), float(12 + (y / HEIGHT - 0.5) * 90)
        trunk = (int(x), int(y - size * 1.1))
        cv2.line(image, (int(x), int(y)), trunk, (62.0, 44.0, 32.0), max(2, int(size / 9)))
        for _ in range(9):
            centre = (x + rng.normal(0, size * 0.4), y - size * 1.5 + rng.normal(0, size * 0.4))
            green = ink_near(rng, (70, 100, 46), 0.45)
            fill(image, blob(rng, centre, size * 0.42), green)


def abstract(rng: np.random.Generator, colour: Rgb) -> Image:
    """Overlapping fields, bars and circles from one palette."""
    palette = one_of(rng, PALETTES)
    image = flat(HEIGHT, WIDTH, one_of(rng, palette))
    for _ in range(34):
        ink = ink_near(rng, one_of(rng, palette), 0.15)
        x, y = (float(v) for v in rng.uniform((0, 0), (WIDTH, HEIGHT)))
        kind = int(rng.integers(4))
        if kind == 0:
            fill(image, blob(rng, (x, y), float(rng.uniform(25, 120)), 9), ink)
        elif kind == 1:
            disc(image, (int(x), int(y)), int(rng.integers(10, 70)), ink, int(rng.choice([-1, 4, 9])))
        elif kind == 2:
            end = (int(x + rng.normal(0, 160)), int(y + rng.normal(0, 160)))
            stroke(image, (int(x), int(y)), end, ink, int(rng.integers(2, 26)))
        else:
            corner = (int(x + rng.integers(20, 150)), int(y + rng.integers(20, 150)))
            block(image, (int(x), int(y)), corner, ink)
    return _painted(rng, image, colour)


def still_life(rng: np.random.Generator, colour: Rgb) -> Image:
    """A table with fruit, bottles and flowers before a dark ground."""
    image = noised(flat(HEIGHT, WIDTH, vary(rng, (96, 78, 60), 0.4)), rng, 1.7, 0.2)
    table = int(HEIGHT * 0.66)
    image[table:] = noised(flat(HEIGHT - table, WIDTH, vary(rng, (176, 140, 102), 0.2)), rng, 1.2, 0.1, 5.0)
    for _ in range(int(rng.integers(2, 5))):
        x, top, half = int(rng.uniform(80, WIDTH - 80)), int(rng.uniform(120, 260)), int(rng.integers(16, 34))
        glass = ink_near(rng, (70, 108, 96), 0.6)
        block(image, (x - half, top + 60), (x + half, table + 40), glass)
        block(image, (x - half // 3, top), (x + half // 3, top + 62), glass)
        stroke(image, (x - half // 2, top + 70), (x - half // 2, table + 20), (236.0, 240.0, 236.0), 4)
    for _ in range(24):
        x, y = int(rng.uniform(50, WIDTH - 50)), int(table + rng.uniform(-10, 70))
        radius = int(rng.integers(14, 36))
        fruit = vary(rng, one_of(rng, ((200, 70, 40), (224, 170, 50), (126, 150, 60), (110, 40, 70))), 0.2)
        disc(image, (int(x), int(y)), radius, scaled(fruit, 0.55))
        disc(image, (int(x - 3), int(y - 4)), int(radius * 0.82), scaled(fruit, 1.0))
        disc(image, (int(x - radius / 3), int(y - radius / 3)), max(2, radius // 6), (250.0, 244.0, 228.0))
    return _painted(rng, image, colour)


def street(rng: np.random.Generator, colour: Rgb) -> Image:
    """Photograph of a row of house fronts with windows and awnings."""
    del colour
    image = flat(HEIGHT, WIDTH, vary(rng, (176, 196, 214), 0.1))
    x = -20
    while x < WIDTH:
        wide, top = int(rng.integers(70, 150)), int(rng.integers(30, 160))
        wall = vary(
            rng, one_of(rng, ((206, 176, 140), (170, 96, 78), (222, 214, 196), (140, 150, 158))), 0.18
        )
        block(image, (x, top), (x + wide, HEIGHT - 60), scaled(wall, 1.0))
        for y in range(top + 18, HEIGHT - 130, 58):
            for wx in range(x + 12, x + wide - 24, 34):
                cv2.rectangle(image, (wx, y), (wx + 20, y + 36), (236.0, 234.0, 228.0), 2)
                pane = ink_near(rng, (66, 78, 92), 0.5)
                block(image, (wx + 2, y + 2), (wx + 18, y + 34), pane)
        awning = ink_near(rng, (160, 60, 50), 0.6)
        block(image, (x + 8, HEIGHT - 118), (x + wide - 8, HEIGHT - 98), awning)
        block(image, (x + 14, HEIGHT - 98), (x + wide - 14, HEIGHT - 60), (48.0, 44.0, 46.0))
        x += wide + int(rng.integers(0, 4))
    image[HEIGHT - 60 :] = noised(flat(60, WIDTH, (112, 110, 108)), rng, 0.8, 0.1)
    return finish(noised(image, rng, 0.4, 0.05))


def poster(rng: np.random.Generator, colour: Rgb) -> Image:
    """Printed poster: headline, lines of text, one motif."""
    del colour
    palette = one_of(rng, PALETTES)
    image = flat(HEIGHT, WIDTH, (240, 234, 220))
    image[40:300, 40 : WIDTH - 40] = np.array(one_of(rng, palette), np.float32)
    for _ in range(12):
        ink = ink_near(rng, one_of(rng, palette), 0.2)
        centre = (float(rng.uniform(90, WIDTH - 90)), float(rng.uniform(80, 260)))
        fill(image, blob(rng, centre, float(rng.uniform(14, 60)), 7), ink)
    words = ("KONZERT", "MUSEUM", "JAZZ", "ATLAS", "FLORA", "LISBOA", "CINEMA", "BAUHAUS", "SALON", "1968")
    text = " ".join(str(w) for w in rng.choice(words, 2, replace=False))
    write(image, text, (44, 374), 2.0, (36.0, 34.0, 40.0), 5)
    for y in range(404, 490, 17):
        for x in range(46, WIDTH - 60, 14):
            if rng.random() > 0.25:
                cv2.line(image, (x, y), (x + int(rng.integers(4, 11)), y), (80.0, 78.0, 80.0), 4)
    return finish(noised(image, rng, 0.8, 0.02))


def _painted(rng: np.random.Generator, image: FloatArray, _colour: Rgb) -> Image:
    """Canvas weave and brush strokes over a finished composition."""
    image = noised(image, rng, 0.7, 0.06, 2.5)
    return finish(noised(image, rng, 0.2, 0.025))
