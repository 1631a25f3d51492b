"""Things drawn as one picture: book spines, doors, clocks, radiators, views from a window. RGB."""

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
    modulate,
    noised,
    one_of,
    scaled,
    smooth,
    spectral_noise,
    stroke,
    vary,
    write,
)

SPINES = 32  # spines side by side in one `books` picture
COVERS: tuple[Rgb, ...] = (
    *((120, 34, 36), (34, 58, 98), (46, 84, 62), (198, 168, 112), (232, 226, 210)),
    *((52, 48, 52), (188, 96, 44), (98, 70, 110), (70, 116, 130)),
)


def books(rng: np.random.Generator, colour: Rgb) -> Image:
    """A strip of SPINES book spines of equal width, each with bands, title and author."""
    del colour
    height, width = 320, 56
    strip = np.empty((height, width * SPINES, 3), np.float32)
    for k in range(SPINES):
        cover = vary(rng, one_of(rng, COVERS), 0.25)
        spine = noised(flat(height, width, cover), rng, 1.0, 0.05)
        ink = (238.0, 228.0, 196.0) if sum(cover) < 380 else (52.0, 40.0, 38.0)
        for _ in range(int(rng.integers(1, 5))):
            y = int(rng.integers(8, height - 8))
            cv2.line(spine, (0, y), (width, y), ink, int(rng.integers(2, 9)))
        if rng.random() < 0.4:
            y = int(rng.integers(20, 230))
            block(
                spine, (5, y), (width - 5, y + int(rng.integers(20, 70))), ink_near(rng, (200, 170, 120), 0.5)
            )
        lying = np.rot90(spine, -1).copy()
        word = "".join(chr(int(c)) for c in rng.integers(65, 91, int(rng.integers(5, 12))))
        write(lying, word, (20, 38), 0.95, ink, 3)
        spine = np.rot90(lying).copy()
        spine *= (1.0 - 0.45 * np.abs(np.linspace(-1, 1, width)) ** 4)[None, :, None]
        strip[:, k * width : (k + 1) * width] = spine
    return finish(strip)


def door(rng: np.random.Generator, colour: Rgb) -> Image:
    """Door leaf with panels shaded as if lit from above. The same for every seed: doors are identical."""
    del rng
    height, width = 1024, 448
    rng = np.random.default_rng(77)
    image = noised(flat(height, width, colour), rng, 0.8, 0.015, 0.333)
    for x0, y0, x1, y1 in ((60, 80, 388, 420), (60, 500, 388, 560), (60, 640, 388, 950)):
        for k in range(9):
            shade = 0.78 + 0.03 * k
            cv2.rectangle(image, (x0 + k, y0 + k), (x1 - k, y1 - k), scaled(colour, shade), 1)
        cv2.line(image, (x0, y1), (x1, y1), tuple(float(min(255, c * 1.06)) for c in colour), 3)
    return finish(image)


def radiator(rng: np.random.Generator, colour: Rgb) -> Image:
    """Panel radiator: vertical flutes."""
    flutes = np.sin(np.linspace(0, 2 * np.pi * 22, 512, dtype=np.float32))
    image = modulate(flat(256, 512, colour), np.broadcast_to(flutes, (256, 512)), 0.12)
    image[:12] *= 0.8
    image[-12:] *= 0.75
    return finish(noised(image, rng, 1.6, 0.02))


def clock(rng: np.random.Generator, colour: Rgb) -> Image:
    """Clock face."""
    size = 256
    image = flat(size, size, colour)
    for k in range(60):
        angle, inner = k * np.pi / 30, 100 if k % 5 else 88
        a = (int(128 + inner * np.cos(angle)), int(128 + inner * np.sin(angle)))
        b = (int(128 + 110 * np.cos(angle)), int(128 + 110 * np.sin(angle)))
        stroke(image, a, b, (30.0, 30.0, 34.0), 2 if k % 5 else 6)
    for length, thick in ((56, 8), (86, 5)):
        angle = float(rng.uniform(0, 6.28))
        tip = (int(128 + length * np.cos(angle)), int(128 + length * np.sin(angle)))
        stroke(image, (128, 128), tip, (20.0, 20.0, 24.0), thick)
    return finish(image)


def panel(rng: np.random.Generator, colour: Rgb) -> Image:
    """Small wall device: casing, display, buttons and a label."""
    image = flat(192, 192, colour)
    cv2.rectangle(image, (8, 8), (183, 183), scaled(colour, 0.85), 3)
    block(image, (30, 30), (160, 96), (58.0, 74.0, 62.0))
    write(image, f"{int(rng.integers(17, 24))}.5", (42, 82), 1.5, (196.0, 222.0, 180.0), 4)
    for k in range(3):
        disc(image, (50 + 46 * k, 136), 13, ink_near(rng, (120, 120, 126), 0.3))
    return finish(image)


def view(rng: np.random.Generator, colour: Rgb) -> Image:
    """Outlook from an upper floor: sky, far town, near trees."""
    height, width = 768, 1024
    rows = np.linspace(0, 1, height, dtype=np.float32)[:, None, None]
    image = np.broadcast_to(
        np.array(colour, np.float32) * (1 - rows) + np.array((236, 238, 236), np.float32) * rows,
        (height, width, 3),
    ).copy()
    clouds = np.clip(spectral_noise(rng, height, width, 1.6, stretch=1.67), 0, 2.2)[..., None] * 0.36
    image = image * (1 - clouds) + 252.0 * clouds
    for distance in (0.45, 0.7, 1.0):
        _houses(rng, image, distance)
    for _ in range(420):
        at = (float(rng.uniform(0, width)), height - abs(float(rng.normal(0, 62))))
        fill(image, blob(rng, at, float(rng.uniform(8, 26))), ink_near(rng, (82, 108, 60), 0.5))
    return finish(noised(image, rng, 0.6, 0.03))


def _houses(rng: np.random.Generator, image: FloatArray, distance: float) -> None:
    """A row of fronts with windows; the smaller `distance` is, the paler and the smaller they are."""
    height, width = image.shape[:2]
    fronts = ((206, 190, 166), (176, 120, 98), (222, 218, 208), (150, 156, 160))
    pane = (int(12 * distance), int(20 * distance))
    x = int(rng.integers(-40, 0))
    while x < width:
        wide = int(rng.integers(60, 170) * distance)
        top = int(height * (0.66 - 0.2 * distance * rng.random()))
        wall = np.array(vary(rng, one_of(rng, fronts), 0.12))
        wall = wall * distance + np.array((205, 214, 222)) * (1 - distance)
        block(image, (x, top), (x + wide, height), scaled(wall, 1.0))
        block(image, (x, top), (x + wide, top + pane[0]), scaled(wall, 0.62))
        for wy in range(top + int(24 * distance), height, max(8, int(40 * distance))):
            for wx in range(x + 6, x + wide - 10, max(8, int(26 * distance))):
                ink = scaled(wall, rng.uniform(0.35, 0.7))
                block(image, (wx, wy), (wx + pane[0], wy + pane[1]), ink)
        x += wide + int(rng.integers(0, 50))


def mirror(rng: np.random.Generator, colour: Rgb) -> Image:
    """Mirror glass showing a still corridor: reflections are painted, not rendered."""
    height, width = 512, 256
    rows = np.linspace(0, 1, height, dtype=np.float32)[:, None, None]
    image = np.broadcast_to(np.array(colour, np.float32) * (1.06 - 0.2 * rows), (height, width, 3)).copy()
    block(image, (0, 0), (width, 60), (236.0, 234.0, 228.0))
    block(image, (0, 420), (width, height), (176.0, 160.0, 138.0))
    block(image, (30, 130), (120, 440), (222.0, 216.0, 204.0))
    cv2.rectangle(image, (30, 130), (120, 440), (150.0, 144.0, 134.0), 3)
    picture = cv2.resize(np.ascontiguousarray(rng.integers(40, 220, (5, 6, 3)).astype(np.float32)), (80, 64))
    image[190:254, 150:230] = picture
    cv2.rectangle(image, (146, 186), (233, 257), (60.0, 46.0, 36.0), 4)
    return finish(noised(smooth(image, 2.0), rng, 2.0, 0.03))
