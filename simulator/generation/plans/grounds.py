"""Ground under the open sky: a street between houses, a works yard. Pure."""

import numpy as np

from simulator.generation.plans.rectangles import Plan, Rect, RoomPlan

STREETS_M = ((26.0, 6.0, 11.5), (39.0, 6.0, 12.0), (52.0, 7.0, 12.5))
"""Length, width of the street and depth of the gardens on either side, by size."""
YARDS_M = ((14.0, 12.0), (22.0, 18.0), (34.0, 26.0))


def street_plan(size: int, rng: np.random.Generator) -> Plan:
    """A street along x with gardens north and south of it.

    Args:
        size: 0 to 2.
        rng: draws the measures.
    """
    long_m, wide_m, deep_m = (round(side * float(rng.uniform(0.95, 1.1)), 1) for side in STREETS_M[size])
    street = Rect(0.0, 0.0, long_m, wide_m)
    north, south = Rect(0.0, wide_m, long_m, wide_m + deep_m), Rect(0.0, -deep_m, long_m, 0.0)
    plans = (("street", "street", street), ("north", "garden_south", north), ("south", "garden_north", south))
    rooms = tuple(RoomPlan(name, use, rect, border="fence") for name, use, rect in plans)
    return Plan(rooms, (), (2.0, round(wide_m / 2, 2)))


def yard_plan(size: int, rng: np.random.Generator) -> Plan:
    """A walled yard.

    Args:
        size: 0 to 2.
        rng: draws the measures.
    """
    wide_m, deep_m = (round(side * float(rng.uniform(0.9, 1.1)), 1) for side in YARDS_M[size])
    rooms = (RoomPlan("yard", "yard", Rect(0.0, 0.0, wide_m, deep_m), border="wall"),)
    return Plan(rooms, (), (2.0, round(deep_m / 2, 2)))
