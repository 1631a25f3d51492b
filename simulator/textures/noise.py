"""Periodic noise and small drawing aids that the texture kinds share. Pure numpy and OpenCV."""

import functools
from collections.abc import Iterable, Sequence
from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

Image = npt.NDArray[np.uint8]
FloatArray = npt.NDArray[np.float32]
Rgb = tuple[int, int, int]
Ink = tuple[float, ...]
Pixel = Sequence[int]
T = TypeVar("T")


def spectral_noise(
    rng: np.random.Generator, height: int, width: int, exponent: float = 1.5, stretch: float = 1.0
) -> FloatArray:
    """Periodic noise with spectrum 1 / f^exponent, normalised to mean 0 and standard deviation 1.

    Args:
        rng: source of randomness.
        height: rows, pixels.
        width: columns, pixels.
        exponent: 0 is white noise, 2 is cloud-like.
        stretch: features are that many times longer along the rows than across them.

    Returns:
        (height, width) array that tiles without a seam.
    """
    white = rng.standard_normal((height, width), np.float32)
    field = np.fft.irfft2(np.fft.rfft2(white) * _filter(height, width, exponent, stretch), s=(height, width))
    return np.asarray(field / max(float(field.std()), 1e-9), np.float32)


@functools.cache
def _filter(height: int, width: int, exponent: float, stretch: float) -> FloatArray:
    """1 / f^exponent over the half plane of a real transform, 0 at f = 0; cached, as the powers cost most."""
    fy = np.fft.fftfreq(height)[:, None] * height
    fx = np.fft.rfftfreq(width)[None, :] * width * stretch
    radius = np.sqrt(fx * fx + fy * fy)
    radius[0, 0] = np.inf
    return np.asarray(radius**-exponent, np.float32)


def flat(height: int, width: int, colour: Rgb) -> FloatArray:
    """One colour as a (height, width, 3) float array, 0 to 255."""
    return np.broadcast_to(np.array(colour, np.float32), (height, width, 3)).copy()


def modulate(image: FloatArray, field: FloatArray, strength: float) -> FloatArray:
    """Brighten and darken an image by a (height, width) field: image * (1 + strength * field)."""
    factor = strength * field
    factor += 1.0
    return image * factor[..., None]


def noised(
    image: FloatArray, rng: np.random.Generator, exponent: float, strength: float, stretch: float = 1.0
) -> FloatArray:
    """An image brightened and darkened by periodic noise, see `spectral_noise` and `modulate`."""
    height, width = image.shape[:2]
    return modulate(image, spectral_noise(rng, height, width, exponent, stretch), strength)


def finish(image: FloatArray) -> Image:
    """Clip to 0..255 and round to bytes."""
    rounded = np.rint(image)
    np.clip(rounded, 0, 255, out=rounded)  # in place: fresh memory costs more than the arithmetic
    return rounded.astype(np.uint8)


def vary(rng: np.random.Generator, colour: Rgb, spread: float) -> Rgb:
    """A colour near the given one: each channel scaled by 1 +- spread."""
    scaled = np.array(colour) * rng.uniform(1.0 - spread, 1.0 + spread) * rng.uniform(0.97, 1.03, 3)
    r, g, b = np.clip(scaled, 0, 255).astype(int).tolist()
    return r, g, b


def ink_near(rng: np.random.Generator, colour: Rgb, spread: float) -> Ink:
    """A colour near the given one, as OpenCV draws with it."""
    red, green, blue = vary(rng, colour, spread)
    return float(red), float(green), float(blue)


def scaled(colour: Iterable[float], factor: float) -> Ink:
    """A colour times a factor, as OpenCV draws with it."""
    return tuple(float(channel * factor) for channel in colour)


def one_of(rng: np.random.Generator, choices: Sequence[T]) -> T:
    """One of several, each as likely as the others."""
    return choices[int(rng.integers(len(choices)))]


def disc(image: FloatArray, centre: Pixel, radius: int, ink: Ink | float, thick: int = -1) -> None:
    """Draw a filled circle, or its line of some thickness, with smooth edges."""
    cv2.circle(image, centre, radius, ink, thick, cv2.LINE_AA)


def oval(
    image: FloatArray,
    centre: Pixel,
    axes: tuple[int, int],
    angle: float,
    ink: Ink | float,
    thick: int = -1,
    arc: tuple[float, float] = (0, 360),
) -> None:
    """Draw a filled ellipse, or its line, turned by an angle in degrees; `arc` is the part that is drawn."""
    cv2.ellipse(image, centre, axes, angle, *arc, ink, thick, cv2.LINE_AA)


def block(image: FloatArray, corner: Pixel, opposite: Pixel, ink: Ink | float) -> None:
    """Draw a filled rectangle."""
    cv2.rectangle(image, corner, opposite, ink, -1)


def stroke(image: FloatArray, start: Pixel, end: Pixel, ink: Ink | float, thick: int) -> None:
    """Draw a line with smooth edges."""
    cv2.line(image, start, end, ink, thick, cv2.LINE_AA)


def fill(image: FloatArray, outline: npt.NDArray[np.int32], ink: Ink | float) -> None:
    """Draw a filled polygon with smooth edges."""
    cv2.fillPoly(image, [outline], ink, cv2.LINE_AA)


def blob(
    rng: np.random.Generator, centre: tuple[float, float], radius: float, points: int = 14
) -> npt.NDArray[np.int32]:
    """An irregular closed outline around a centre, (points, 1, 2) integer pixels, for cv2.fillPoly."""
    angles = np.linspace(0, 2 * np.pi, points, endpoint=False)
    radii = radius * rng.uniform(0.65, 1.3, points)
    xy = np.stack([centre[0] + radii * np.cos(angles), centre[1] + radii * np.sin(angles)], axis=-1)
    return xy.astype(np.int32).reshape(-1, 1, 2)


def smooth(image: FloatArray, sigma_px: float) -> FloatArray:
    """Gaussian blur that wraps round the borders, so that a periodic image stays periodic."""
    pad = int(3 * sigma_px) + 1
    wrapped = cv2.copyMakeBorder(image, pad, pad, pad, pad, cv2.BORDER_WRAP)
    return np.asarray(cv2.GaussianBlur(wrapped, (0, 0), sigma_px), np.float32)[pad:-pad, pad:-pad]


def write(
    image: FloatArray, text: str, at: tuple[int, int], scale: float, ink: tuple[float, ...], thick: int
) -> None:
    """Draw text in place from the left end of its base line; by a mask, as OpenCV 5 writes on bytes only."""
    mask = np.zeros(image.shape[:2], np.uint8)
    cv2.putText(mask, text, at, cv2.FONT_HERSHEY_SIMPLEX, scale, 255, thick, cv2.LINE_AA)
    weight = mask[..., None].astype(np.float32) / 255.0
    image[...] = image * (1.0 - weight) + np.array(ink, np.float32) * weight
