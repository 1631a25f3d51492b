"""Heading methods by name, all with one signature."""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from services.planner.heading.combine import Combination
from services.planner.heading.epipolar import epipolar
from services.planner.heading.estimate import HeadingEstimate
from services.planner.heading.histogram import method_by_histogram
from services.planner.heading.method_1 import method_1
from services.planner.heading.method_2 import method_2
from services.planner.heading.method_3 import method_3
from services.planner.heading.method_4 import method_4
from services.planner.heading.method_5 import method_5
from services.planner.heading.method_6 import method_6
from services.planner.heading.weights import WeightSettings
from shared.geometry.two_view_types import TwoViewResult, checked_matches

MethodName = Literal["epipolar", "histogram", "1", "2", "3", "4", "5", "6"]
METHOD_NAMES: tuple[str, ...] = get_args(MethodName)

HeadingMethod = Callable[[npt.ArrayLike, npt.ArrayLike, TwoViewResult | None], HeadingEstimate]


def heading_method(
    name: str, weight: WeightSettings | None = None, combination: Combination = "raw"
) -> HeadingMethod:
    """Method `name` as a function heading(current_lonlat, target_lonlat, two_view) -> HeadingEstimate.

    Both arrays are (N, 2) longitude, latitude, radians. 'epipolar' reads only the two-view result, the
    others only the
    matches: pass them the verified ones, since a steep weight lets one wrong match decide (THESIS 1c).

    Args:
        name: one of METHOD_NAMES.
        weight: weight function of methods 2, 4, 5 and 6; None for exp of degrees.
        combination: how methods 5 and 6 add their parts.

    Raises:
        ValueError: unknown name.
    """
    if name not in METHOD_NAMES:
        raise ValueError(f"unknown heading method {name!r}, choose one of {', '.join(METHOD_NAMES)}")
    f = weight or WeightSettings()

    def heading(
        current: npt.ArrayLike, target: npt.ArrayLike, two_view: TwoViewResult | None = None
    ) -> HeadingEstimate:
        c, t = checked_matches(np.reshape(current, (-1, 2)), np.reshape(target, (-1, 2)))
        if name == "epipolar":
            return epipolar(two_view)
        resultants = {
            "1": lambda: method_1(c, t),
            "2": lambda: method_2(c, t, f),
            "3": lambda: method_3(c, t),
            "4": lambda: method_4(c, t, f),
            "5": lambda: method_5(c, t, f, combination),
            "6": lambda: method_6(c, t, f, combination),
        }
        return resultants[method_by_histogram(c) if name == "histogram" else name]().estimate()

    return heading
