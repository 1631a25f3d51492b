"""Method 2: method 1 with each bisector weighted by how much its pair spread; equations (2.8) to (2.10)."""

from services.planner.heading.estimate import Resultant, weighted_sum
from services.planner.heading.pairs import pair_votes
from services.planner.heading.weights import WeightSettings
from shared.geometry.angles import FloatArray


def method_2(current: FloatArray, target: FloatArray, weight: WeightSettings) -> Resultant:
    """Heading vector from (N, 2) longitudes and latitudes (rad) of both frames; latitudes are not used."""
    votes = pair_votes(current, target)
    return weighted_sum(votes.directions, weight.log_weights(votes.growth_rad))
