"""Rugs and carpets. RGB, one picture per rug, borders included."""

import cv2
import numpy as np

from simulator.textures.noise import (
    FloatArray,
    Image,
    Ink,
    Rgb,
    block,
    disc,
    fill,
    finish,
    flat,
    ink_near,
    noised,
    one_of,
    oval,
    scaled,
)


def persian(rng: np.random.Generator, colour: Rgb) -> Image:
    """Oriental rug: nested borders, medallion, scattered flowers; four-fold symmetric, then worn unevenly."""
    height, width = 512, 384  # one quarter
    yarns = ((228, 206, 164), (34, 46, 84), (196, 144, 70), (120, 132, 108), (84, 30, 34))
    inks = [ink_near(rng, yarn, 0.15) for yarn in yarns]
    quarter = flat(height, width, colour)
    for inset, ink in ((0, 1), (14, 0), (26, 4), (70, 2), (80, 1), (92, 0)):
        block(quarter, (inset, inset), (2 * width, 2 * height), inks[ink])
    block(quarter, (98, 98), (2 * width, 2 * height), scaled(colour, 1.0))
    for t in range(34, 2 * height, 36):
        _flower(quarter, (48, t), 13, inks[0], inks[2])
        _flower(quarter, (t, 48), 13, inks[0], inks[2])
    for _ in range(60):
        x, y = (int(v) for v in rng.integers(118, (width - 20, height - 20)))
        _flower(quarter, (x, y), int(rng.integers(6, 16)), one_of(rng, inks), one_of(rng, inks))
        oval(quarter, (x + 16, y + 12), (22, 16), float(rng.uniform(0, 360)), inks[3], 3, arc=(0, 150))
    for radius, ink in ((190, 1), (168, 2), (150, 4), (96, 0), (70, 1), (34, 2)):
        oval(quarter, (width, height), (int(radius * 0.8), radius), 0, inks[ink])
    half = np.concatenate([quarter, quarter[:, ::-1]], axis=1)
    whole = np.concatenate([half, half[::-1]], axis=0)
    return _pile(rng, whole)


def _flower(image: FloatArray, centre: tuple[int, int], radius: int, petal: Ink, heart: Ink) -> None:
    for k in range(6):
        x = centre[0] + 0.7 * radius * np.cos(k * np.pi / 3)
        y = centre[1] + 0.7 * radius * np.sin(k * np.pi / 3)
        disc(image, (int(x), int(y)), max(2, int(radius * 0.42)), petal)
    disc(image, centre, max(1, int(radius * 0.4)), heart)


def kilim(rng: np.random.Generator, colour: Rgb) -> Image:
    """Flat-woven rug: bands of lozenges and zigzags."""
    height, width = 1024, 640
    image = flat(height, width, colour)
    yarns = ((226, 212, 184), (52, 62, 78), (190, 92, 58), (208, 162, 84), (96, 120, 108))
    inks = [ink_near(rng, yarn, 0.2) for yarn in yarns]
    y = 0
    while y < height:
        band = int(rng.integers(36, 110))
        block(image, (0, y), (width, y + band), one_of(rng, inks))
        step, ink = int(rng.integers(32, 80)), one_of(rng, inks)
        for x in range(0, width + step, step):
            wide, middle = step // 2, y + band // 2
            fill(
                image, np.array([[x, y + 4], [x + wide, middle], [x, y + band - 4], [x - wide, middle]]), ink
            )
            disc(image, (x, y + band // 2), band // 7, one_of(rng, inks))
        cv2.line(image, (0, y), (width, y), inks[1], 5)
        y += band
    return _pile(rng, image)


def modern(rng: np.random.Generator, colour: Rgb) -> Image:
    """Tufted rug with overlapping arcs and fields in muted tones."""
    height, width = 896, 640
    yarns = ((198, 186, 168), (110, 118, 124), (176, 116, 88), (66, 74, 84), (150, 158, 140))
    image = flat(height, width, colour)
    for _ in range(26):
        ink = ink_near(rng, one_of(rng, yarns), 0.15)
        centre = (int(rng.integers(0, width)), int(rng.integers(0, height)))
        thick = int(rng.choice([-1, 8, 16, 24]))
        axes, angle = (int(rng.integers(30, 190)), int(rng.integers(30, 190))), float(rng.uniform(0, 360))
        oval(image, centre, axes, angle, ink, thick, arc=(0, float(rng.uniform(120, 360))))
    return _pile(rng, image)


def _pile(rng: np.random.Generator, image: FloatArray) -> Image:
    image = noised(image, rng, 0.35, 0.08)
    return finish(noised(image, rng, 1.7, 0.07))
