"""Frames arrive as late as the level says, in order, and as many are lost."""

import pytest

from simulator.disturbances.transit import MOST_LOST, MOST_S, Transit

MS = 1_000_000


def test_a_frame_arrives_after_its_delay_and_once():
    transit = Transit(latency=0.3 / MOST_S, drops=0.0, seed=1)
    transit.expose("a", 1000 * MS)
    transit.expose("b", 1200 * MS)
    assert transit.arrived(1299 * MS) == []
    assert transit.arrived(1300 * MS) == ["a"]
    assert transit.arrived(1600 * MS) == ["b"]
    assert transit.arrived(9000 * MS) == []


def test_without_delay_a_frame_is_there_at_once():
    transit = Transit(latency=0.0, drops=0.0, seed=1)
    transit.expose("a", 5)
    assert transit.arrived(5) == ["a"]


def test_what_is_under_way_can_be_void():
    transit = Transit(latency=1.0, drops=0.0, seed=1)
    transit.expose("a", 0)
    transit.clear()
    assert transit.arrived(9000 * MS) == []


@pytest.mark.parametrize("level", [0.0, 0.2, 1.0])
def test_the_share_of_lost_frames_is_that_of_the_level_and_the_same_for_a_seed(level):
    lost = [Transit(0.0, level, 7).loses(seq) for seq in range(1000)]
    assert sum(lost) / 1000 == pytest.approx(level * MOST_LOST, abs=0.05)
    assert lost == [Transit(0.0, level, 7).loses(seq) for seq in range(1000)]
