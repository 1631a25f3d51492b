"""Method 4: method 3 with each match weighted by how much its latitude grew; equations (2.17) and (2.18)."""

from services.planner.heading.estimate import Resultant, weighted_sum
from services.planner.heading.latitudes import latitude_votes
from services.planner.heading.weights import WeightSettings
from shared.geometry.angles import FloatArray


def method_4(current: FloatArray, target: FloatArray, weight: WeightSettings) -> Resultant:
    """Heading vector from (N, 2) longitudes and latitudes (rad) of both frames."""
    votes = latitude_votes(current, target)
    return weighted_sum(votes.directions, weight.log_weights(votes.growth_rad))
