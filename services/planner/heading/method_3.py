"""Method 3: longitude vectors of single matches, signed by their latitudes; equations (2.11) to (2.16)."""

from services.planner.heading.estimate import Resultant, weighted_sum
from services.planner.heading.latitudes import latitude_votes
from services.planner.heading.weights import UNWEIGHTED
from shared.geometry.angles import FloatArray


def method_3(current: FloatArray, target: FloatArray) -> Resultant:
    """Heading vector from (N, 2) longitudes and latitudes (rad) of both frames."""
    votes = latitude_votes(current, target)
    return weighted_sum(votes.directions, UNWEIGHTED.log_weights(votes.growth_rad))
