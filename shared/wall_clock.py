"""The time of day wherever a rule is about it: one minute, told in any time zone."""

import time
from dataclasses import dataclass
from datetime import UTC, datetime
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from shared.mapgraph.rules import LocalTime


@dataclass(frozen=True)
class WallClock:
    """One minute.

    Attributes:
        minute: since the Unix epoch.
    """

    minute: int

    @classmethod
    def now(cls) -> "WallClock":
        """This machine's."""
        return cls(int(time.time() // 60))

    def local(self, time_zone: str) -> LocalTime | None:
        """Day and time there; None for a time zone that is not known here."""
        zone = zone_called(time_zone)
        if zone is None:
            return None
        there = datetime.fromtimestamp(60 * self.minute, UTC).astimezone(zone)
        return LocalTime(there.weekday(), f"{there:%H:%M}")


def zone_called(name: str) -> ZoneInfo | None:
    """A time zone by its IANA name; None for one that is not known here."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return None
