"""Rate limits of a gateway, and what counts as one client. Buckets: bursts, filling, a bounded memory."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.requests import HTTPConnection

from services.gateway.http.rates import MOST_KEYS, RateLimits, TokenBuckets, address_of
from services.gateway.settings import GatewaySettings
from shared.web.problems import ProblemError


class Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    """Time as the test wants it."""
    return Clock()


@pytest.fixture
def limits(clock: Clock) -> RateLimits:
    """Three wrong tokens at once, then one each ten seconds."""
    return RateLimits(
        GatewaySettings(failure_burst=3, failures_per_s=0.1, write_burst=2, writes_per_s=0.5), clock
    )


def guess(limits: RateLimits, address: str, digest: str, right: bool = False) -> None:
    limits.before_token(address, digest)
    limits.after_token(address, digest, right)


def test_too_many_wrong_tokens_are_not_looked_at_any_more(limits: RateLimits, clock: Clock) -> None:
    for number in range(3):
        guess(limits, "10.0.0.1", f"wrong {number}")
    with pytest.raises(ProblemError) as caught:
        limits.before_token("10.0.0.1", "right")
    assert (caught.value.status_code, caught.value.members["retry_after_s"]) == (429, 10)
    limits.before_token("10.0.0.2", "right")
    clock.now_s = 10.1
    limits.before_token("10.0.0.1", "right")


def test_who_guesses_beside_an_operator_does_not_lock_the_operator_out(limits: RateLimits) -> None:
    guess(limits, "10.0.0.1", "operator", right=True)
    for number in range(3):
        guess(limits, "10.0.0.1", f"wrong {number}")
    limits.before_token("10.0.0.1", "operator")
    with pytest.raises(ProblemError):
        limits.before_token("10.0.0.1", "wrong again")


def test_right_tokens_are_never_too_many(limits: RateLimits) -> None:
    for _ in range(100):
        guess(limits, "10.0.0.1", "right", right=True)


def test_writes_are_counted_by_client_and_say_when_to_come_again(limits: RateLimits, clock: Clock) -> None:
    limits.write("token anna")
    limits.write("token anna")
    limits.write("token bert")
    with pytest.raises(ProblemError) as caught:
        limits.write("token anna")
    assert (caught.value.status_code, caught.value.members["retry_after_s"]) == (429, 2)
    clock.now_s = 2.0
    limits.write("token anna")


def test_proven_tokens_take_a_bounded_memory(limits: RateLimits) -> None:
    for number in range(MOST_KEYS + 100):
        limits.after_token("10.0.0.1", str(number), right=True)
    assert len(limits._proven) == MOST_KEYS


@pytest.mark.parametrize(
    ("host", "client"),
    [
        ("10.0.0.1", "10.0.0.1"),
        ("::1", "::1"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("2001:db8:1:2:ffff::9", "2001:db8:1:2::/64"),
        ("::ffff:10.0.0.1", "::ffff:10.0.0.1"),
        ("testclient", "testclient"),
    ],
)
def test_a_network_of_ipv6_is_one_client(host: str, client: str) -> None:
    found = address_of(HTTPConnection({"type": "http", "headers": [], "client": (host, 1)}))
    assert found in (client, "::ffff:a00:1")


def test_a_burst_passes_then_one_for_each_period() -> None:
    buckets = TokenBuckets(rate_per_s=2.0, burst=3)
    assert [buckets.take("a", 0.0) for _ in range(3)] == [0.0, 0.0, 0.0]
    assert buckets.take("a", 0.0) == pytest.approx(0.5)
    assert buckets.take("a", 0.5) == 0.0
    assert buckets.take("a", 0.5) == pytest.approx(0.5)


def test_clients_do_not_take_from_each_other() -> None:
    buckets = TokenBuckets(rate_per_s=1.0, burst=1)
    assert buckets.take("a", 0.0) == 0.0
    assert buckets.take("b", 0.0) == 0.0
    assert buckets.take("a", 0.0) > 0.0


def test_waiting_does_not_fill_beyond_the_burst() -> None:
    buckets = TokenBuckets(rate_per_s=1.0, burst=2)
    buckets.take("a", 0.0)
    assert [buckets.take("a", 1e6) == 0.0 for _ in range(3)] == [True, True, False]


def test_memory_is_bounded_and_the_oldest_client_is_forgotten() -> None:
    buckets = TokenBuckets(rate_per_s=0.001, burst=1, most_keys=10)
    for number in range(1000):
        buckets.take(f"client {number}", float(number) * 1e-6)
    assert len(buckets) == 10
    assert buckets.take("client 999", 0.001) > 0.0
    assert buckets.take("client 0", 0.001) == 0.0


@settings(deadline=None)
@given(st.lists(st.floats(0.0, 3.0), min_size=1, max_size=80), st.floats(0.1, 50.0), st.integers(1, 20))
def test_no_more_pass_than_burst_and_rate_allow(gaps: list[float], rate_per_s: float, burst: int) -> None:
    buckets, now_s, passed = TokenBuckets(rate_per_s, burst), 0.0, 0
    for gap_s in gaps:
        now_s += gap_s
        passed += buckets.take("a", now_s) == 0.0
    assert passed <= burst + rate_per_s * now_s + 1e-6
