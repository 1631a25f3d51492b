"""What every ROS message with a header has in common: frame and stamp, and how a bad one is named. Pure."""

import math
from collections.abc import Iterable
from typing import Any

NS_PER_S = 1_000_000_000


class ConversionError(ValueError):
    """A message whose content nothing may move for; the text says what was expected and what came."""


def stamp_s(message: Any) -> float | None:
    """When it was measured by the robot's clock, seconds; None where the driver does not say (zero)."""
    stamp = message.header.stamp
    seconds = stamp.sec + stamp.nanosec / NS_PER_S
    return seconds if seconds else None


def check_frame(message: Any, expected: str) -> None:
    """Refuse a message of another frame than the file describes: its numbers would be read wrongly.

    Args:
        message: any message with a header.
        expected: frame_id of the robot's file, "" for whichever comes.

    Raises:
        ConversionError: it is another one.
    """
    came = message.header.frame_id
    if expected and came != expected:
        raise ConversionError(f"frame {expected!r} expected, got {came[:80]!r}")


def check_finite(what: str, values: Iterable[float]) -> None:
    """Refuse NaN and infinity.

    Raises:
        ConversionError: there is one; names `what`.
    """
    if not all(math.isfinite(value) for value in values):
        raise ConversionError(f"{what} must be finite, got NaN or infinity")
