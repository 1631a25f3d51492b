"""Stops that come together are sent as one, which is never older than any of them."""

import asyncio

import pytest

from services.gateway.live.coalescing import Coalescer


def test_stops_of_one_robot_that_come_together_are_sent_once():
    sent = []

    async def send() -> int:
        sent.append("r1")
        return len(sent)

    async def flood() -> list[int]:
        stops = Coalescer()
        return await asyncio.gather(*(stops.join("r1", send) for _ in range(50)))

    assert asyncio.run(flood()) == [1] * 50
    assert sent == ["r1"]


def test_a_stop_that_comes_while_one_is_on_its_way_is_sent_after_it():
    sent = []

    async def two() -> None:
        stops, on_its_way, answered = Coalescer(), asyncio.Event(), asyncio.Event()

        async def slow() -> None:
            sent.append("first")
            on_its_way.set()
            await answered.wait()

        async def quick() -> None:
            sent.append("second")

        first = asyncio.create_task(stops.join("r1", slow))
        await on_its_way.wait()
        await stops.join("r1", quick)
        answered.set()
        await first

    asyncio.run(two())
    assert sent == ["first", "second"]


def test_robots_do_not_share_stops():
    async def both() -> list[str]:
        stops = Coalescer()

        async def send(robot: str) -> str:
            return robot

        names = ("r1", "r2")
        return await asyncio.gather(*(stops.join(name, lambda name=name: send(name)) for name in names))

    assert asyncio.run(both()) == ["r1", "r2"]


def test_who_leaves_takes_nobody_s_stop_along_and_all_hear_why_one_failed():
    async def run() -> None:
        stops = Coalescer()

        async def fail() -> None:
            raise ConnectionError("drive is absent")

        waiting = [asyncio.create_task(stops.join("r1", fail)) for _ in range(3)]
        await asyncio.sleep(0)
        waiting[0].cancel()
        for task in waiting[1:]:
            with pytest.raises(ConnectionError):
                await task

    asyncio.run(run())
