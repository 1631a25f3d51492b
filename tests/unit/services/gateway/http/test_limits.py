"""Rate limits of a gateway, and what counts as one client."""

import pytest
from starlette.requests import HTTPConnection

from services.gateway.http.buckets import MOST_KEYS
from services.gateway.http.limits import Limits, address_of
from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings


class Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    """Time as the test wants it."""
    return Clock()


@pytest.fixture
def limits(clock: Clock) -> Limits:
    """Three wrong tokens at once, then one each ten seconds."""
    return Limits(
        GatewaySettings(failure_burst=3, failures_per_s=0.1, write_burst=2, writes_per_s=0.5), clock
    )


def guess(limits: Limits, address: str, digest: str, right: bool = False) -> None:
    limits.before_token(address, digest)
    limits.after_token(address, digest, right)


def test_too_many_wrong_tokens_are_not_looked_at_any_more(limits: Limits, clock: Clock) -> None:
    for number in range(3):
        guess(limits, "10.0.0.1", f"wrong {number}")
    with pytest.raises(ProblemError) as caught:
        limits.before_token("10.0.0.1", "right")
    assert (caught.value.status, caught.value.members["retry_after_s"]) == (429, 10)
    limits.before_token("10.0.0.2", "right")
    clock.now_s = 10.1
    limits.before_token("10.0.0.1", "right")


def test_who_guesses_beside_an_operator_does_not_lock_the_operator_out(limits: Limits) -> None:
    guess(limits, "10.0.0.1", "operator", right=True)
    for number in range(3):
        guess(limits, "10.0.0.1", f"wrong {number}")
    limits.before_token("10.0.0.1", "operator")
    with pytest.raises(ProblemError):
        limits.before_token("10.0.0.1", "wrong again")


def test_right_tokens_are_never_too_many(limits: Limits) -> None:
    for _ in range(100):
        guess(limits, "10.0.0.1", "right", right=True)


def test_writes_are_counted_by_client_and_say_when_to_come_again(limits: Limits, clock: Clock) -> None:
    limits.write("token anna")
    limits.write("token anna")
    limits.write("token bert")
    with pytest.raises(ProblemError) as caught:
        limits.write("token anna")
    assert (caught.value.status, caught.value.members["retry_after_s"]) == (429, 2)
    clock.now_s = 2.0
    limits.write("token anna")


def test_proven_tokens_take_a_bounded_memory(limits: Limits) -> None:
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
