"""Does a robot drive on while many have the gateway compare pictures? Headings a second beside readers.

On one machine the readers take processor time as well. Never gates on how fast it was.
"""

import asyncio
import contextlib
import multiprocessing
import time

import pytest

from services.launcher.client.mission import MissionClient
from services.launcher.client.stack import StackChoice, open_stack
from shared.bus import wait_until
from shared.messages.missions import MissionRequest
from shared.topics import HEADING

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

READERS, DURING_S, NODES = (40, 200), 15.0, 4


def test_headings_a_second_beside_readers_who_compare_pictures(tmp_path, keep):
    with open_stack(StackChoice(tmp_path, "apartment", seed=1, lockstep=False)) as stack:
        client = MissionClient(stack.bus, stack.robot)
        client.wait_for_frame(0)
        started = client.ask(MissionRequest(action="explore", map="flat", seed=1))
        assert wait_until(lambda: client.ask(MissionRequest(action="status")).nodes >= NODES, 120.0), started
        rates = {"alone": headings_per_s(stack)}
        for count in READERS:
            reader = multiprocessing.get_context("spawn").Process(
                target=flood, args=(stack.gateway_url, count, DURING_S + 3.0)
            )
            reader.start()
            time.sleep(2.0)
            rates[f"beside_{count}"] = headings_per_s(stack)
            reader.join()
            rates[f"after_{count}"] = headings_per_s(stack)
        assert client.ask(MissionRequest(action="status")).state == "running"
    keep(rates)
    assert all(rate > 0.0 for rate in rates.values())


def headings_per_s(stack):
    with stack.session() as own:
        headings = own.bus.subscribe(HEADING, robot=own.robot)
        began_s, count = time.monotonic(), 0
        while time.monotonic() < began_s + DURING_S:
            own.bus.wait(0.2)
            count += len(headings.take_all())
        return count / (time.monotonic() - began_s)


def flood(url, count, during_s):
    """So many connections that ask again as soon as they are answered."""
    host, port = url.removeprefix("http://").split(":")
    request = f"GET /api/maps/flat/edges/0/1/matches HTTP/1.1\r\nHost: {host}:{port}\r\n\r\n".encode()

    async def read():
        while True:
            try:
                reader, writer = await asyncio.open_connection(host, int(port))
                while True:
                    writer.write(request)
                    head = (await reader.readuntil(b"\r\n\r\n")).lower()
                    length = next(line for line in head.split(b"\r\n") if line.startswith(b"content-length"))
                    await reader.readexactly(int(length.split(b":")[1]))
            except (OSError, asyncio.IncompleteReadError, StopIteration):
                await asyncio.sleep(0.01)

    async def all_of_them():
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(asyncio.gather(*(read() for _ in range(count))), during_s)

    asyncio.run(all_of_them())
