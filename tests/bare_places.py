"""What a place needs to be written to a map, and nothing that could be recognised."""

import numpy as np

from shared.messages.base import SECTORS
from shared.messages.features import Features

FEATURES = Features(
    pipeline="x",
    lonlat_rad=np.zeros((1, 2), np.float32),
    scores=np.zeros(1, np.float32),
    descriptors=np.zeros((1, 4), np.uint8),
)


def sectors(*known: int) -> tuple[bool, ...]:
    """Directions of a place, true for those given."""
    return tuple(n in known for n in range(SECTORS))
