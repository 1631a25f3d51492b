"""What happens to a picture between the scene and the bus, in the order in which light meets it. Pure."""

from dataclasses import dataclass

from simulator.disturbances.exposure import exposed, stops
from simulator.disturbances.levels import Disturbances, generator
from simulator.disturbances.noise import noisy
from simulator.disturbances.rain import rained
from simulator.sensors.panorama import Image

NIGHT_NOISE = 0.35  # a camera that has little light turns its gain up; chosen


@dataclass(frozen=True)
class Moment:
    """What the draws of one picture depend on: the seed, simulated time, and where it is taken."""

    seed: int
    time_s: float
    place: tuple[float, float, float]


def degraded(picture: Image, levels: Disturbances, moment: Moment) -> Image:
    """Rain, exposure and noise on a picture, (height, width, 3) BGR; all levels 0 return it as it is."""
    seed, time_s = moment.seed, moment.time_s
    picture = rained(picture, levels.rain, seed, time_s)
    if levels.exposure:
        picture = exposed(picture, stops(levels.exposure, seed, time_s))
    noise = max(levels.noise, NIGHT_NOISE * levels.illumination)
    if noise == 0.0:
        return picture
    return noisy(picture, noise, generator(seed, "noise", time_s, *moment.place))
