"""What a camera does to a panorama: exposure, blur, a turn during it, two lenses, noise. Pure."""

from dataclasses import dataclass

import cv2
import numpy as np

from experiments.training.data.recipe import DataRecipe
from experiments.training.sights import Image
from simulator.disturbances.exposure import exposed
from simulator.disturbances.noise import noisy

LEAST_BLUR_PX = 0.3
"""Less is none: OpenCV's kernel would be a single pixel."""


@dataclass(frozen=True)
class Degradation:
    """What is done to one picture; 0 everywhere does nothing.

    Attributes:
        stops: error of the exposure.
        blur_px: sigma of an even blur.
        smear_px: columns over which a turn spreads every point.
        seam: difference in brightness of the back half against the front half.
        seam_px: rows by which the back half lies lower.
        noise: level of `simulator.disturbances.noise`.
        quality: of the JPEG that is kept, percent.
    """

    stops: float = 0.0
    blur_px: float = 0.0
    smear_px: int = 0
    seam: float = 0.0
    seam_px: int = 0
    noise: float = 0.0
    quality: int = 95


def drawn(recipe: DataRecipe, rng: np.random.Generator) -> Degradation:
    """How one picture is degraded; each part is off in half of the degraded pictures."""
    quality = int(rng.integers(recipe.jpeg[0], recipe.jpeg[1] + 1))
    on, amount = rng.random(5) < 0.5, rng.random(5)
    sign = np.where(rng.random(3) < 0.5, -1.0, 1.0)
    if rng.random() >= recipe.disturbed:
        return Degradation(quality=quality)
    amount = np.where(on, amount, 0.0)
    return Degradation(
        stops=float(sign[0] * amount[0] * recipe.exposure_stops),
        blur_px=float(amount[1] * recipe.blur_px),
        smear_px=round(amount[2] * recipe.smear_px),
        seam=float(sign[1] * amount[3] * recipe.seam),
        seam_px=round(sign[2] * amount[3] * recipe.seam_px),
        noise=float(amount[4] * recipe.noise),
        quality=quality,
    )


def degraded(picture: Image, how: Degradation, rng: np.random.Generator) -> Image:
    """The picture (H, 2H, 3) as that camera would deliver it, in the order in which light meets it."""
    picture = _two_lenses(exposed(picture, how.stops), how.seam, how.seam_px)
    if how.smear_px > 1:
        wide = cv2.copyMakeBorder(picture, 0, 0, how.smear_px, how.smear_px, cv2.BORDER_WRAP)
        picture = cv2.blur(wide, (how.smear_px, 1))[:, how.smear_px : -how.smear_px]
    if how.blur_px > LEAST_BLUR_PX:
        edge = int(4 * how.blur_px) + 1
        wide = cv2.copyMakeBorder(picture, 0, 0, edge, edge, cv2.BORDER_WRAP)
        picture = cv2.GaussianBlur(wide, (0, 0), how.blur_px)[:, edge:-edge]
    return noisy(np.ascontiguousarray(picture), how.noise, rng)


def _two_lenses(picture: Image, seam: float, seam_px: int) -> Image:
    """The outer quarters, which the back lens sees, brighter or darker and a little shifted."""
    if seam == 0.0 and seam_px == 0:
        return picture
    joined = picture.copy()
    quarter = picture.shape[1] // 4
    for part in (slice(0, quarter), slice(3 * quarter, None)):
        back = np.roll(picture[:, part], seam_px, axis=0).astype(np.float32) * (1.0 + seam)
        joined[:, part] = np.clip(np.rint(back), 0, 255).astype(np.uint8)
    return joined
