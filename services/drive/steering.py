"""What an avoidance strategy decides."""

from typing import NamedTuple


class Steering(NamedTuple):
    """Direction to drive in (robot frame) and why.

    Attributes:
        clearance_m: free way in that direction; limits the speed.
        blocked: no direction is free; stand still.
    """

    heading_rad: float
    avoiding: bool
    why: str
    clearance_m: float = float("inf")
    blocked: bool = False
