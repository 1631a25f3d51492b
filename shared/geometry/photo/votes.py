"""How a photo is turned against a panorama taken near it: rotations that pairs of matches agree on. Pure."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import FloatArray

TOLERANCE_RAD = float(np.deg2rad(6.0))
"""What a way between the two may move things by; chosen: half a metre from things five metres off."""
UPRIGHT = float(np.cos(np.deg2rad(25.0)))
"""Least cosine between the verticals: phones are held upright to some 15 degrees, the rest is tolerance."""
PAIRS = 200
"""Hypotheses; with a third of the matches right, 22 of them are right."""
TINY = 1e-9
"""Keeps a vector from being divided by nothing."""


@dataclass(frozen=True, eq=False)
class Vote:
    """The rotation (3, 3) from the photo's camera to the panorama's, and the right matches that it explains.

    Attributes:
        weight: their probabilities together.
        count: their number.
    """

    rotation: FloatArray
    weight: float
    count: int


def vote(photo: FloatArray, panorama: FloatArray, right: FloatArray, rng: np.random.Generator) -> Vote | None:
    """The rotation that most matches agree on; None where no two do.

    Args:
        photo: (N, 3) unit bearings in the photo's camera.
        panorama: (N, 3) of the same matches in the panorama's.
        right: (N,) probability that each is right.
        rng: draws the pairs.
    """
    if len(right) < 2:
        return None
    pairs = rng.choice(len(right), (PAIRS, 2), p=right / right.sum())
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    here, apart = _frames(photo[pairs[:, 0]], photo[pairs[:, 1]])
    there, apart_there = _frames(panorama[pairs[:, 0]], panorama[pairs[:, 1]])
    rotation = there @ np.swapaxes(here, 1, 2)
    rotation = rotation[(rotation[:, 2, 2] > UPRIGHT) & (np.abs(apart - apart_there) < TOLERANCE_RAD)]
    if not len(rotation):
        return None
    cosine = np.einsum("hkl,nl,nk->hn", rotation, photo, panorama)
    agree = cosine > np.cos(TOLERANCE_RAD)
    best = int(np.argmax(agree @ right))
    return Vote(rotation[best], float(agree[best] @ right), int(agree[best].sum()))


def _frames(first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Axes (H, 3, 3) in columns that two bearings span, and the angles (H,) between the two."""
    up = np.cross(first, second)
    sine = np.linalg.norm(up, axis=1)
    up = up / np.maximum(sine, TINY)[:, None]
    middle = first + second
    middle = middle / np.maximum(np.linalg.norm(middle, axis=1), TINY)[:, None]
    angle = np.arctan2(sine, np.sum(first * second, axis=1))
    return np.stack([middle, np.cross(up, middle), up], axis=-1), angle
