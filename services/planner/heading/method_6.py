"""Method 6: the sum of methods 2 and 4 (THESIS row 21, section 3.2.1)."""

from services.planner.heading.combine import Combination, combine
from services.planner.heading.estimate import Resultant
from services.planner.heading.method_2 import method_2
from services.planner.heading.method_4 import method_4
from services.planner.heading.weights import WeightSettings
from shared.geometry.angles import FloatArray


def method_6(
    current: FloatArray, target: FloatArray, weight: WeightSettings, combination: Combination = "raw"
) -> Resultant:
    """Heading vector from (N, 2) longitudes and latitudes (rad) of both frames."""
    return combine(method_2(current, target, weight), method_4(current, target, weight), combination)
