"""Token buckets: bursts, filling, and a bounded memory."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.gateway.http.buckets import Buckets


def test_a_burst_passes_then_one_for_each_period() -> None:
    buckets = Buckets(rate_per_s=2.0, burst=3)
    assert [buckets.take("a", 0.0) for _ in range(3)] == [0.0, 0.0, 0.0]
    assert buckets.take("a", 0.0) == pytest.approx(0.5)
    assert buckets.take("a", 0.5) == 0.0
    assert buckets.take("a", 0.5) == pytest.approx(0.5)


def test_clients_do_not_take_from_each_other() -> None:
    buckets = Buckets(rate_per_s=1.0, burst=1)
    assert buckets.take("a", 0.0) == 0.0
    assert buckets.take("b", 0.0) == 0.0
    assert buckets.take("a", 0.0) > 0.0


def test_waiting_does_not_fill_beyond_the_burst() -> None:
    buckets = Buckets(rate_per_s=1.0, burst=2)
    buckets.take("a", 0.0)
    assert [buckets.take("a", 1e6) == 0.0 for _ in range(3)] == [True, True, False]


def test_memory_is_bounded_and_the_oldest_client_is_forgotten() -> None:
    buckets = Buckets(rate_per_s=0.001, burst=1, most_keys=10)
    for number in range(1000):
        buckets.take(f"client {number}", float(number) * 1e-6)
    assert len(buckets) == 10
    assert buckets.take("client 999", 0.001) > 0.0
    assert buckets.take("client 0", 0.001) == 0.0


@settings(deadline=None)
@given(st.lists(st.floats(0.0, 3.0), min_size=1, max_size=80), st.floats(0.1, 50.0), st.integers(1, 20))
def test_no_more_pass_than_burst_and_rate_allow(gaps: list[float], rate_per_s: float, burst: int) -> None:
    buckets, now_s, passed = Buckets(rate_per_s, burst), 0.0, 0
    for gap_s in gaps:
        now_s += gap_s
        passed += buckets.take("a", now_s) == 0.0
    assert passed <= burst + rate_per_s * now_s + 1e-6
