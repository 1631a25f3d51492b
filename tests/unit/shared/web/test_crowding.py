"""Who comes in when there are many: who says nothing makes room, and a reserve is for what must be heard."""

import re

import pytest

from shared.web.crowding import RESERVE, Admission, ConnectionLimits, Crowd, client_of

HERE, THERE = "127.0.0.1", "10.0.0.1"


class Fake:
    """A connection that counts how often it was ended."""

    def __init__(self) -> None:
        self.evicted = 0

    def evict(self) -> None:
        self.evicted += 1


def crowd(most: int = 4, most_per_client: int = 2, always: str | None = "/stop", **options) -> Crowd:
    pattern = None if always is None else re.compile(always)
    return Crowd(ConnectionLimits(1.0, 1.0, most, most_per_client, always=pattern, **options))


def enter(crowd: Crowd, host: str, count: int, waiting: bool = True) -> list[Fake]:
    made = [Fake() for _ in range(count)]
    for one in made:
        assert crowd.admit(one, host) is Admission.FREE
        if waiting:
            crowd.waits(one)
    return made


def test_the_one_of_its_client_that_waited_longest_makes_room():
    held = crowd()
    elsewhere, (first, second) = enter(held, THERE, 1), enter(held, HERE, 2)
    enter(held, HERE, 1)
    assert [one.evicted for one in (first, second, *elsewhere)] == [1, 0, 0]
    held.works(second)
    enter(held, HERE, 1)
    assert second.evicted == 0, "a request that is being answered is left alone"


def test_when_there_are_most_in_all_any_that_waits_makes_room():
    held = crowd(most=2)
    first = enter(held, THERE, 1) + enter(held, "10.0.0.2", 1)
    enter(held, HERE, 1)
    assert [one.evicted for one in first] == [1, 0]


@pytest.mark.parametrize("hosts", [(HERE,) * 2, (THERE, "10.0.0.2", "10.0.0.3", "10.0.0.4")])
def test_where_all_are_busy_a_newcomer_is_heard_on_what_is_reserved_only(hosts):
    held = crowd()
    for host in hosts:
        enter(held, host, 1, waiting=False)
    assert held.admit(Fake(), HERE) is Admission.RESERVED


def test_what_is_reserved_makes_room_as_well():
    held = crowd()
    enter(held, HERE, 2, waiting=False)
    reserved = [Fake() for _ in range(RESERVE + 1)]
    for one in reserved:
        assert held.admit(one, HERE) is Admission.RESERVED
        held.waits(one)
    assert [one.evicted for one in reserved] == [1] + [0] * RESERVE


def test_without_a_reserve_it_is_refused():
    held = crowd(always=None)
    enter(held, HERE, 2, waiting=False)
    assert held.admit(Fake(), HERE) is Admission.REFUSED


def test_what_has_ended_counts_no_more():
    held = crowd()
    first, _ = enter(held, HERE, 2, waiting=False)
    held.forget(first)
    held.forget(first)
    enter(held, HERE, 1)
    assert first.evicted == 0


def test_a_proxy_has_no_share_of_its_own():
    enter(crowd(unlimited=[HERE]), HERE, 4, waiting=False)


@pytest.mark.parametrize(
    ("host", "client"),
    [
        ("10.0.0.1", "10.0.0.1"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("::1", "::1"),
        ("::ffff:10.0.0.1", "::ffff:a00:1"),
        ("testclient", "testclient"),
    ],
)
def test_an_address_of_ipv6_counts_for_its_network(host, client):
    assert client_of(host) == client
