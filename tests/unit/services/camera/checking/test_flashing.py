"""The delay of a camera, by a screen that changes before it."""

from bisect import bisect_right

import numpy as np
import pytest

from services.camera.checking.flashing import MOST_DELAY_S, Change, delay_of, next_change_s

SECONDS = 12.0


def changes(rng):
    found, at_s = [], 0.0
    while (at_s := at_s + next_change_s(rng)) < SECONDS:
        found.append(Change(100.0 + at_s, len(found) % 2 == 0))
    return found


def seen(flashes, rate_hz, delay_s, rng, contrast=40.0):
    """Arrivals, and brightness of 50 parts, of which one shows the screen."""
    exposed_s = 100.0 + np.arange(0.0, SECONDS, 1.0 / rate_hz)
    times = [change.at_s for change in flashes]
    parts = rng.normal(100.0, 3.0, (len(exposed_s), 50))
    for number, at_s in enumerate(exposed_s):
        place = bisect_right(times, at_s) - 1
        parts[number, 17] += contrast * (place >= 0 and flashes[place].bright)
    return exposed_s + delay_s, parts


@pytest.mark.parametrize("delay_s", [0.0, 0.12, 0.4, 1.6])
@pytest.mark.parametrize("rate_hz", [5.0, 30.0])
def test_the_delay_is_found_to_less_than_a_picture(delay_s, rate_hz):
    rng = np.random.default_rng(3)
    flashes = changes(rng)
    found = delay_of(flashes, *seen(flashes, rate_hz, delay_s, rng))
    assert found == pytest.approx(delay_s, abs=0.6 / rate_hz)


def test_a_screen_out_of_sight_is_not_guessed_at():
    rng = np.random.default_rng(4)
    flashes = changes(rng)
    assert delay_of(flashes, *seen(flashes, 10.0, 0.3, rng, contrast=0.0)) is None


def test_a_screen_later_than_any_camera_is_not_taken_for_a_short_delay():
    rng = np.random.default_rng(5)
    flashes = changes(rng)
    assert delay_of(flashes, *seen(flashes, 10.0, MOST_DELAY_S + 1.0, rng)) is None


def test_too_few_changes_tell_nothing():
    rng = np.random.default_rng(6)
    flashes = changes(rng)[:3]
    assert delay_of(flashes, *seen(flashes, 10.0, 0.3, rng)) is None
    assert delay_of([], [], np.zeros(0)) is None
