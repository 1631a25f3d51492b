"""Due times: by the clocks of a time zone, also when these are put forward or back; missed ones; bad text."""

from datetime import datetime
from itertools import islice
from zoneinfo import ZoneInfo

import pytest

from shared.schedules.due_times import NS, Due, DueTimes, ScheduleError

ZURICH = ZoneInfo("Europe/Zurich")
MINUTE = 60 * NS


def at(text: str) -> int:
    """A moment, by the clocks of Zurich where the text names no offset."""
    moment = datetime.fromisoformat(text)
    return round((moment if moment.tzinfo else moment.replace(tzinfo=ZURICH)).timestamp()) * NS


def times(cron: str, after: str, most: int) -> list[str]:
    found = islice(DueTimes(cron, "Europe/Zurich").after(at(after)), most)
    return [datetime.fromtimestamp(at_ns // NS, ZURICH).isoformat() for at_ns in found]


def test_due_by_the_clocks_of_the_time_zone_all_year():
    times = DueTimes("30 7 * * MON-FRI", "Europe/Zurich")
    assert times.next(at("2026-01-02T07:30")) == at("2026-01-05T06:30+00:00")
    assert times.next(at("2026-07-03T07:29:59")) == at("2026-07-03T05:30+00:00")


@pytest.mark.parametrize(
    ("cron", "after", "expected"),
    [
        pytest.param(
            "30 2 * * *",
            "2026-03-28T12:00",
            ["2026-03-29T03:00:00+02:00", "2026-03-30T02:30:00+02:00"],
            id="a time that does not exist is due when the clock was put forward",
        ),
        pytest.param(
            "30 2 * * *",
            "2026-10-24T12:00",
            ["2026-10-25T02:30:00+02:00", "2026-10-26T02:30:00+01:00"],
            id="a time that comes twice is due the first time",
        ),
        pytest.param(
            "0 * * * *",
            "2026-10-25T01:30",
            ["2026-10-25T02:00:00+02:00", "2026-10-25T02:00:00+01:00", "2026-10-25T03:00:00+01:00"],
            id="every hour goes by the hours that pass",
        ),
        pytest.param(
            "30 2 * * *",
            "2026-10-25T02:10+01:00",
            ["2026-10-26T02:30:00+01:00"],
            id="what a clock that was put back shows again is no later time",
        ),
    ],
)
def test_when_clocks_change(cron: str, after: str, expected: list[str]):
    assert times(cron, after, len(expected)) == expected


DAILY = DueTimes("0 8 * * *", "Europe/Zurich")
EIGHT = "2026-06-02T08:00"


@pytest.mark.parametrize(
    ("handled", "now", "due"),
    [
        pytest.param("2026-06-01T08:00", "2026-06-02T07:59", Due(None, False), id="not yet"),
        pytest.param("2026-06-01T08:00", EIGHT, Due(at(EIGHT), False), id="now"),
        pytest.param("2026-06-01T08:00", "2026-06-02T08:09", Due(at(EIGHT), False), id="nine minutes late"),
        pytest.param("2026-06-01T08:00", "2026-06-02T08:11", Due(None, True), id="too late"),
        pytest.param("2026-05-01T08:00", EIGHT, Due(at(EIGHT), True), id="earlier ones were missed"),
        pytest.param(EIGHT, "2026-06-02T08:01", Due(None, False), id="handled"),
    ],
)
def test_what_is_due(handled: str, now: str, due: Due):
    assert DAILY.due(at(handled), at(now), 10 * MINUTE) == due


def test_of_several_missed_times_the_newest_counts():
    every = DueTimes("* * * * *", "UTC")
    now_ns = at("2026-06-02T08:00:30")
    found = every.due(now_ns - 5 * MINUTE, now_ns, 10 * MINUTE)
    assert found == Due(at("2026-06-02T08:00"), missed=True)
    year_ns = 365 * 24 * 60 * MINUTE
    assert every.due(now_ns - year_ns, now_ns, 10 * MINUTE) == found, "without reading a year of minutes"


@pytest.mark.parametrize(
    ("cron", "says"),
    [
        ("61 * * * *", "field minute cannot be '61'"),
        ("0 25 * * *", "field hour cannot be '25'"),
        ("0 0 32 * *", "field day-of-month cannot be '32'"),
        ("0 0 1 13 *", "field month cannot be '13'"),
        ("0 0 * * FUNDAY", "field day-of-week cannot be 'FUNDAY'"),
        ("0 8 * *", "5 fields expected (minute, hour, day-of-month, month, day-of-week), got 4"),
        ("0 0 8 * * *", "got 6"),
    ],
)
def test_text_that_is_no_schedule_names_the_field_and_gives_an_example(cron: str, says: str):
    with pytest.raises(ScheduleError) as caught:
        DueTimes(cron, "UTC").next(0)
    assert says in str(caught.value)
    assert "'30 7 * * MON-FRI' is 7:30 on workdays" in str(caught.value)


def test_an_unknown_time_zone_is_said():
    with pytest.raises(ScheduleError, match=r"unknown time zone 'Mars/Base'.*Europe/Zurich"):
        DueTimes("0 8 * * *", "Mars/Base").next(0)
