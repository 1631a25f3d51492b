"""Fog: of a surface's light exp(-b d) is left after d metres, the rest is the fog's own. Pure.

Koschmieder 1924, on gamma-encoded values; the shader applies it, see shaders/baked/gbuffer.frag.
"""

from dataclasses import dataclass

VISIBILITY_M = {"indoor": 6.0, "outdoor": 30.0}  # at level 1: a black thing keeps 5 % of its contrast
CONTRAST_LN = 3.0  # -ln 0.05
RAIN_SHARE = 0.25  # rain at level 1 hazes like fog at this level
GREY = 0.78  # by eye
DARK = 0.55  # by this much fog without daylight is darker


@dataclass(frozen=True)
class Fog:
    """Extinction per metre and the fog's own light, gamma-encoded 0 to 1."""

    extinction: float
    grey: float


def fog_of(level: float, rain: float, illumination: float, environment: str) -> Fog:
    """Fog at a level in "indoor" or "outdoor" scale; level 0 without rain has no extinction."""
    total = min(1.0, level + RAIN_SHARE * rain)
    return Fog(CONTRAST_LN * total / VISIBILITY_M[environment], GREY * (1.0 - DARK * illumination))
