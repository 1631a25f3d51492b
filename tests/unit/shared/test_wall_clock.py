"""The time of day in any zone, and none where the zone is not known."""

import time

import pytest

from shared.mapgraph.rules import LocalTime
from shared.wall_clock import WallClock, zone_called


@pytest.mark.parametrize(
    ("minute", "zone", "local"),
    [
        (0, "UTC", LocalTime(3, "00:00")),
        (0, "America/New_York", LocalTime(2, "19:00")),
        (1439, "Asia/Tokyo", LocalTime(4, "08:59")),
        (0, "Mars/Base", None),
        (0, "../../etc/passwd", None),
        (0, "", None),
    ],
)
def test_a_minute_is_told_by_the_clocks_there(minute, zone, local):
    assert WallClock(minute).local(zone) == local
    assert (zone_called(zone) is None) == (local is None)


def test_now_is_the_minute_that_runs():
    before = time.time() // 60
    assert before <= WallClock.now().minute <= time.time() // 60
