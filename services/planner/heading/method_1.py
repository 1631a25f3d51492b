"""Method 1 (after [34]): signed bisectors of all pairs of longitudes, summed; equations (2.1) to (2.7)."""

from services.planner.heading.estimate import Resultant, weighted_sum
from services.planner.heading.pairs import pair_votes
from services.planner.heading.weights import UNWEIGHTED
from shared.geometry.angles import FloatArray


def method_1(current: FloatArray, target: FloatArray) -> Resultant:
    """Heading vector from (N, 2) longitudes and latitudes (rad) of both frames; latitudes are not used."""
    votes = pair_votes(current, target)
    return weighted_sum(votes.directions, UNWEIGHTED.log_weights(votes.growth_rad))
