"""The kinds of worlds that can be generated. Pure."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from simulator.generation.plans.corridor import CorridorStyle, corridor_plan
from simulator.generation.plans.divided import divided_plan
from simulator.generation.plans.grounds import street_plan, yard_plan
from simulator.generation.plans.hall import HallStyle, hall_plan
from simulator.generation.plans.rectangles import Plan

SIZES = ("small", "medium", "large")

HOSTEL = CorridorStyle("bedroom", (3.2, 3.8), (3.8, 4.4), (1.8, 2.2), (2, 4, 6), alike=True)
HOTEL = CorridorStyle("bedroom", (3.6, 4.4), (4.6, 5.6), (1.6, 2.0), (2, 4, 6), True, "storage", 0.1)
SCHOOL = CorridorStyle("classroom", (6.4, 7.6), (5.6, 6.6), (2.4, 3.0), (1, 2, 3), False, "office", 0.2)
OFFICES = CorridorStyle("office", (3.6, 4.6), (4.0, 5.0), (1.6, 2.0), (2, 3, 5), False, "meeting", 0.25)
OPEN_OFFICE = HallStyle(
    "open_office", ((9.0, 8.0), (13.0, 10.0), (18.0, 14.0)), ("meeting", "kitchen", "storage")
)
WAREHOUSE = HallStyle(
    "warehouse", ((12.0, 10.0), (18.0, 14.0), (26.0, 20.0)), ("office", "storage", "storage")
)
SHOP = HallStyle("shop", ((8.0, 7.0), (12.0, 9.0), (17.0, 13.0)), ("storage", "office", "storage"))


@dataclass(frozen=True)
class Kind:
    """One kind of world.

    Attributes:
        plan: draws where its rooms are, for a size of 0 to 2.
        wall_height_m: of its rooms.
        hard: floors and walls of halls.
        signs: numbers beside the doors of its corridors.
    """

    plan: Callable[[int, np.random.Generator], Plan]
    wall_height_m: float = 2.6
    hard: bool = False
    signs: bool = False


KINDS: dict[str, Kind] = {
    "flat": Kind(divided_plan),
    "hostel": Kind(partial(corridor_plan, HOSTEL), signs=True),
    "hotel": Kind(partial(corridor_plan, HOTEL)),
    "school": Kind(partial(corridor_plan, SCHOOL), wall_height_m=3.0, signs=True),
    "offices": Kind(partial(corridor_plan, OFFICES), signs=True),
    "open-office": Kind(partial(hall_plan, OPEN_OFFICE)),
    "warehouse": Kind(partial(hall_plan, WAREHOUSE), wall_height_m=5.0, hard=True),
    "shop": Kind(partial(hall_plan, SHOP), wall_height_m=3.2),
    "street": Kind(street_plan),
    "yard": Kind(yard_plan),
}
