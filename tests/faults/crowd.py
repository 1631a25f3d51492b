"""`python -m tests.faults.crowd ADDRESS read|deaf|stall COUNT CLIENTS`: many who want something of a gateway.

They come from CLIENTS addresses of loopback, 127.0.1.1 and on. One line of JSON tells what became of them;
they stay until killed: readers read, the deaf never do, stalled uploads trickle and come again when ended.
"""

import asyncio
import contextlib
import json
import socket
import sys
from collections import Counter
from urllib.parse import urlsplit

from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

PATIENCE_S = 150.0
AT_ONCE = 25
DROP_S = 1.0
SMALL_BUFFER = 4096
HEAD = (
    "POST /api/robots/r1/goal-check?map=flat HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: image/png\r\n"
    "Content-Length: 1000000\r\n\r\n"
)


class Crowd:
    """Everybody in one asyncio loop.

    Attributes:
        outcome: how many got in, were closed with a code, or failed.
        heard: messages that readers read.
    """

    def __init__(self, address: str, clients: int) -> None:
        parts = urlsplit(address)
        self._host, self._port = str(parts.hostname), int(parts.port or 80)
        self._url, self._clients = f"ws://{parts.netloc}/api/robots/r1/live", clients
        self._room = asyncio.Semaphore(AT_ONCE)
        self.outcome: Counter[str] = Counter()
        self.heard = 0
        self._begun: set[int] = set()

    async def deaf(self, number: int) -> None:
        """Open a WebSocket through a small window and never read."""
        one = socket.socket()
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER)
        one.setblocking(False)
        one.bind((self._source(number), 0))
        loop = asyncio.get_running_loop()
        async with self._room:
            await loop.sock_connect(one, (self._host, self._port))
            await loop.sock_sendall(one, _upgrade(self._url))
        self.outcome["in"] += 1
        await asyncio.Event().wait()

    async def stall(self, number: int) -> None:
        """Begin an upload, send a byte now and then, begin again when it is ended."""
        while True:
            with contextlib.suppress(OSError):
                async with self._room:
                    source = (self._source(number), 0)
                    reader, writer = await asyncio.open_connection(self._host, self._port, local_addr=source)
                    writer.write(HEAD.encode() + b"\x89PNG")
                if number not in self._begun:
                    self._begun.add(number)
                    self.outcome["in"] += 1
                while not reader.at_eof():
                    writer.write(b"x")
                    await writer.drain()
                    with contextlib.suppress(TimeoutError):
                        await asyncio.wait_for(reader.read(4096), DROP_S)
                writer.close()
            await asyncio.sleep(DROP_S / 10)

    async def run(self, what: str, count: int) -> None:
        """Everybody; tells the outcome once everybody has one."""
        tasks = [asyncio.create_task(getattr(self, what)(number)) for number in range(count)]
        async with asyncio.timeout(PATIENCE_S):
            while sum(self.outcome.values()) < count:
                await asyncio.sleep(0.05)
        _tell(dict(self.outcome))
        await asyncio.gather(self._tell_heard(), *tasks)

    async def read(self, number: int) -> None:
        """Open a WebSocket and read what comes."""
        try:
            async with self._room:
                live = await connect(
                    self._url,
                    local_addr=(self._source(number), 0),
                    proxy=None,
                    compression=None,
                    ping_interval=None,
                    open_timeout=PATIENCE_S,
                )
            await live.recv()
        except ConnectionClosed as closed:
            self.outcome[f"closed {closed.rcvd.code if closed.rcvd else 'without a word'}"] += 1
            return
        except (OSError, TimeoutError) as error:
            self.outcome[type(error).__name__] += 1
            return
        self.outcome["in"] += 1
        with contextlib.suppress(ConnectionClosed):
            async for _ in live:
                self.heard += 1

    async def _tell_heard(self) -> None:
        """What was read in each second."""
        while True:
            before = self.heard
            await asyncio.sleep(1.0)
            _tell({"heard": self.heard - before})

    def _source(self, number: int) -> str:
        return f"127.0.1.{1 + number % self._clients}"


def _upgrade(url: str) -> bytes:
    parts = urlsplit(url)
    return (
        f"GET {parts.path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
    ).encode()


def _tell(facts: dict[str, int]) -> None:
    sys.stdout.write(json.dumps(facts) + "\n")
    sys.stdout.flush()


async def main(address: str, what: str, count: str, clients: str) -> None:
    """Gather them and stay."""
    await Crowd(address, int(clients)).run(what, int(count))


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
