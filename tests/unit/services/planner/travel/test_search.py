"""Looking for something known: back first, then sweeps that grow and turn."""

import math

from services.planner.travel.search import FIRST_STEPS, search_back


def test_the_first_sweep_goes_back():
    search = search_back(math.radians(30.0), 100)
    headings = {round(math.degrees(search.next_heading())) for _ in range(FIRST_STEPS)}
    assert headings == {-150}


def test_sweeps_grow_never_repeat_a_direction_and_end():
    search = search_back(0.0, 200)
    lengths: dict[float, int] = {}
    while not search.exhausted:
        heading = round(search.next_heading(), 6)
        lengths[heading] = lengths.get(heading, 0) + 1
    assert sum(lengths.values()) == 200
    whole = list(lengths.values())[:-1]
    assert whole == sorted(whole)
    assert len(lengths) >= 5
    assert all(abs(heading) <= math.pi + 1e-6 for heading in lengths)
