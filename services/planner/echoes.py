"""Whether twelve distances contradict a view that resembles a node's (perceptual aliasing). Pure.

Along a corrugated wall, views one rib apart agree as if they were of one spot. What stands around differs: of
pairs of spots 0.8 to 2.5 m apart three in four show it, of pairs at most 0.3 m apart none
(tests/benchmarks/test_spots_by_distances.py, decision 0047).
"""

import numpy as np

from shared.mapgraph.frontiers import SECTOR_RAD, sector_rad
from shared.messages.base import SECTORS
from shared.messages.maps import Node
from shared.messages.sensors import Ranges

SLACK_M, SLACK_SHARE = 0.4, 0.3
"""Readings of one thing from spots 0.3 m apart differ by less; chosen."""
DIFFERING_MAX = 4
"""Of SECTORS readings so many may differ at one spot: a corner seen past, a leg of a table hit or missed."""


def by_sector_m(ranges: Ranges) -> tuple[float, ...]:
    """The reading nearest to the middle of each sector of the robot's frame; at most the sensors' range."""
    angles_rad = np.array(ranges.angles_rad)
    off_rad = [np.abs(np.angle(np.exp(1j * (angles_rad - sector_rad(s))))) for s in range(SECTORS)]
    return tuple(min(ranges.distances_m[int(off.argmin())], ranges.max_range_m) for off in off_rad)


def is_elsewhere(node: Node, ranges: Ranges, yaw_rad: float) -> bool:
    """Whether the distances tell that the robot does not stand at a node.

    A reading agrees with the node's where it lies between those of the two sectors next to its direction.

    Args:
        node: with the distances measured there; one without contradicts nothing.
        ranges: the distances here.
        yaw_rad: of the node's camera in the robot's frame.
    """
    if node.echoes_m is None:
        return False
    turned = (np.arange(SECTORS) * SECTOR_RAD - yaw_rad) / SECTOR_RAD
    there_m = np.array(node.echoes_m)
    beside_m = np.stack([there_m[(np.floor(turned) + k).astype(int) % SECTORS] for k in (0, 1)])
    least_m, most_m, here_m = beside_m.min(axis=0), beside_m.max(axis=0), np.array(by_sector_m(ranges))
    slack_m = SLACK_M + SLACK_SHARE * np.minimum(least_m, here_m)
    return int(((here_m < least_m - slack_m) | (here_m > most_m + slack_m)).sum()) > DIFFERING_MAX
