"""Random generators that depend on nothing but the seed, a purpose and numbers such as time and place."""

import numpy as np

MOST = 2**32


def generator(seed: int, purpose: str, *numbers: float) -> np.random.Generator:
    """The same arguments give the same draws, whatever was drawn before; numbers count in millionths."""
    return np.random.default_rng(
        [seed, *purpose.encode(), *(round(number * 1e6) % MOST for number in numbers)]
    )
