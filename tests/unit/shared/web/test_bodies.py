"""Bodies: too long, too slow, and what of a refused one is still read."""

import asyncio

import pytest
from starlette.types import Message

from shared.web.bodies import BodyLimit, limited
from shared.web.problems import ProblemError


def part(length: int, more: bool) -> Message:
    return {"type": "http.request", "body": bytes(length), "more_body": more}


def received(limit: BodyLimit, *parts: Message, pause_s: float = 0.0) -> tuple[int, int]:
    """Bytes that came through, and parts that were taken from the sender."""
    waiting, taken = list(parts), 0

    async def receive() -> Message:
        nonlocal taken
        taken += 1
        await asyncio.sleep(pause_s)
        return waiting.pop(0)

    async def read() -> int:
        take, length, more = limited(receive, limit), 0, True
        while more:
            message = await take()
            length, more = length + len(message["body"]), message["more_body"]
        return length

    return asyncio.run(read()), taken


def test_a_body_within_its_limits_comes_through() -> None:
    assert received(BodyLimit(30, 5.0), part(10, True), part(20, False)) == (30, 2)


def test_a_longer_one_is_read_to_its_end_and_refused() -> None:
    parts = [part(20, True), part(20, True), part(20, False)]
    with pytest.raises(ProblemError) as caught:
        received(BodyLimit(30, 5.0), *parts)
    assert (caught.value.status_code, caught.value.code) == (413, "body_too_large")
    assert "expected at most 30 bytes, got at least 60 bytes" in caught.value.detail


def test_of_one_without_an_end_so_much_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shared.web.bodies.DRAIN_BYTES", 100)
    taken = 0

    async def endless() -> Message:
        nonlocal taken
        taken += 1
        return part(50, True)

    with pytest.raises(ProblemError):
        asyncio.run(limited(endless, BodyLimit(30, 5.0))())  # type: ignore[arg-type]
    assert taken == 3


@pytest.mark.parametrize("limit", [BodyLimit(99, 0.05), BodyLimit(99, 0.05, bytes_per_s=1e-3)])
def test_a_part_that_does_not_come_is_refused(limit: BodyLimit) -> None:
    with pytest.raises(ProblemError) as caught:
        received(limit, part(1, False), pause_s=30.0)
    assert (caught.value.status_code, caught.value.code) == (408, "body_too_slow")


def test_the_whole_body_must_come_in_time_unless_it_keeps_to_a_rate() -> None:
    parts = [part(10, True)] * 9 + [part(10, False)]
    assert received(BodyLimit(100, 1.0, bytes_per_s=10.0), *parts, pause_s=0.15) == (100, 10)
    with pytest.raises(ProblemError) as caught:
        received(BodyLimit(100, 1.0), *parts, pause_s=0.15)
    assert caught.value.code == "body_too_slow"


def test_after_the_end_the_sender_may_be_silent() -> None:
    async def run() -> None:
        parts = [part(1, False)]

        async def receive() -> Message:
            if parts:
                return parts.pop()
            await asyncio.sleep(0.2)
            return {"type": "http.disconnect"}

        take = limited(receive, BodyLimit(9, 0.05))
        await take()
        assert (await take())["type"] == "http.disconnect"

    asyncio.run(run())
