"""When a schedule is due: five fields of cron, read by the clocks of a time zone.

Where clocks are put forward, a time that does not exist is due when they have been; where they are put back,
a time that comes twice is due the first time. With a star for minute or hour it is due whenever a clock
shows it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import takewhile

from cronsim import CronSim, CronSimError

from shared.wall_clock import zone_called

NS = 1_000_000_000
FIELDS = ("minute", "hour", "day-of-month", "month", "day-of-week")
EXAMPLE = "'30 7 * * MON-FRI' is 7:30 on workdays"
EPOCH = datetime.fromtimestamp(0, UTC)


class ScheduleError(ValueError):
    """Text that is no schedule: says which field, and gives an example."""


@dataclass(frozen=True)
class Due:
    """What there is to do at a moment.

    Attributes:
        at_ns: the newest due time that has come and is not too old; None for none.
        missed: an earlier one has come as well, that nobody handled and nobody will.
    """

    at_ns: int | None
    missed: bool


@dataclass(frozen=True)
class DueTimes:
    """Times at which a schedule is due."""

    cron: str
    time_zone: str

    def after(self, moment_ns: int) -> Iterator[int]:
        """Due times after a moment, in order; nanoseconds since the Unix epoch.

        Raises:
            ScheduleError: no such schedule or time zone.
        """
        zone = zone_called(self.time_zone)
        if zone is None:
            raise ScheduleError(f"unknown time zone {self.time_zone!r}: an IANA name such as Europe/Zurich")
        fields = self.cron.split()
        if len(fields) != len(FIELDS):
            raise ScheduleError(
                f"{len(FIELDS)} fields expected ({', '.join(FIELDS)}), got {len(fields)}: {EXAMPLE}"
            )
        there = datetime.fromtimestamp(moment_ns // NS, UTC).astimezone(zone)
        try:
            times = CronSim(self.cron, there)
        except (CronSimError, AssertionError) as error:
            raise ScheduleError(f"{_fault(fields, str(error))}: {EXAMPLE}") from None
        due = (round((time - EPOCH).total_seconds()) * NS for time in times)
        return (at_ns for at_ns in due if at_ns > moment_ns)  # a clock that was put back shows earlier ones

    def next(self, moment_ns: int) -> int | None:
        """The first due time after a moment; None where there is none within 50 years.

        Raises:
            ScheduleError: no such schedule or time zone.
        """
        return next(self.after(moment_ns), None)

    def due(self, handled_ns: int, now_ns: int, within_ns: int) -> Due:
        """What is due now.

        Args:
            handled_ns: due times until then were handled.
            now_ns: the moment, nanoseconds since the Unix epoch.
            within_ns: an older due time is missed for good.

        Raises:
            ScheduleError: no such schedule or time zone.
        """
        first = self.next(handled_ns)
        if first is None or first > now_ns:
            return Due(None, missed=False)
        recent = list(takewhile(lambda at: at <= now_ns, self.after(max(handled_ns, now_ns - within_ns))))
        newest = recent[-1] if recent else None
        return Due(newest, missed=newest != first)


def _fault(fields: list[str], told: str) -> str:
    """Which field is wrong, and what stands there."""
    for name, field in zip(FIELDS, fields, strict=True):
        if told.endswith(name):
            return f"field {name} cannot be {field!r}"
    return told or "no schedule"
