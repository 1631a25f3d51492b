"""What waits for a slow reader."""

import pytest

from services.gateway.live.outbox import MAX_WAITING, Outbox


@pytest.mark.asyncio
async def test_of_states_only_the_newest_waits_and_events_stay_in_order() -> None:
    outbox = Outbox()
    outbox.offer_newest("status", "old")
    outbox.offer("first")
    outbox.offer_newest("status", "new")
    outbox.offer("second")
    assert await outbox.take() == ["first", "second", "new"]


def test_too_many_events_mark_the_reader_as_too_slow_and_take_no_more_memory() -> None:
    outbox = Outbox()
    for number in range(MAX_WAITING):
        outbox.offer(str(number))
    assert not outbox.overflowed
    for _ in range(1000):
        outbox.offer("more")
        outbox.offer_newest("ranges", "r")
    assert outbox.overflowed


@pytest.mark.asyncio
async def test_the_waiting_queue_is_bounded() -> None:
    outbox = Outbox()
    for _ in range(10 * MAX_WAITING):
        outbox.offer("x")
    assert len(await outbox.take()) == MAX_WAITING
