"""Two sets of floor outlines as one, for what stands and what walks. Pure."""

import numpy as np

from simulator.world.footprints import Footprints


def combined(standing: Footprints, walking: Footprints) -> Footprints:
    """All outlines of both; the second has rectangles and discs only."""
    return Footprints(
        np.concatenate([standing.centres_m, walking.centres_m]),
        np.concatenate([standing.halves_m, walking.halves_m]),
        np.concatenate([standing.yaws_rad, walking.yaws_rad]),
        np.concatenate([standing.disc_centres_m, walking.disc_centres_m]),
        np.concatenate([standing.disc_radii_m, walking.disc_radii_m]),
        standing.polygons_m,
    )
