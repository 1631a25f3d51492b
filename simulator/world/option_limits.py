"""Bounds on options in world files: what no furniture needs is refused before anything is built. Pure."""

import math
import reprlib

MOST_NUMBER = 1000.0
MOST_COUNT = 200  # shelves, doors, leaves
MOST_LENGTH_M = 100.0
MOST_VALUES = 100
MOST_TEXT = 200
MOST_PARTS = 3000
MOST_SIZE_M = 400.0


def check_value(name: str, value: object, depth: int = 0) -> None:
    """Raise ValueError if an option holds a number out of bounds, or too much."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        if not (math.isfinite(value) and abs(value) <= MOST_NUMBER):
            raise ValueError(f"{name}: must be a number within +-{MOST_NUMBER:g}, got {short(value)}")
        if depth == 0 and isinstance(value, int) and abs(value) > MOST_COUNT:
            raise ValueError(f"{name}: must be at most {MOST_COUNT}, got {short(value)}")
        if name.endswith("_m") and not 0 <= value <= MOST_LENGTH_M:
            raise ValueError(f"{name}: must be a length of 0 to {MOST_LENGTH_M:g} m, got {short(value)}")
    elif isinstance(value, str):
        if len(value) > MOST_TEXT:
            raise ValueError(f"{name}: must have at most {MOST_TEXT} characters, got {len(value)}")
    elif isinstance(value, list | tuple | dict):
        if len(value) > MOST_VALUES or depth > 3:
            raise ValueError(f"{name}: must hold at most {MOST_VALUES} values, got {short(value)}")
        for one in value.values() if isinstance(value, dict) else value:
            check_value(name, one, depth + 1)


def short(value: object) -> str:
    """Representation of a value, cut to a line."""
    return reprlib.repr(value)[:80]
