"""Foxglove as this project's live view sees it: a WebSocket client that speaks foxglove.sdk.v1."""

import json
import struct
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

from websockets.sync.client import connect
from websockets.typing import Subprotocol

PROTOCOL = "foxglove.sdk.v1"
CLOSE_S = 0.2
DATA, DATA_HEAD = 1, struct.Struct("<BIQ")
"""First byte of a message; then the number of the subscription and the time in nanoseconds."""
UNKNOWN = "Unknown channel ID: "
"""What foxglove-sdk 0.30 says to a client that asks for a channel at once: it tells of it, then knows it."""


class FoxgloveClient:
    """Knows the channels that the server told of, and keeps what came in those that it listens to."""

    def __init__(self, port: int) -> None:
        self._opened = connect(
            f"ws://127.0.0.1:{port}",
            subprotocols=[Subprotocol(PROTOCOL)],
            max_size=None,
            close_timeout=CLOSE_S,  # what is unread stands before the server's farewell
        )
        self.channels: dict[str, dict[str, Any]] = {}
        self.server: dict[str, Any] = {}
        self._names: dict[int, str] = {}
        self.came: dict[str, list[bytes]] = {}

    def __enter__(self) -> Self:
        self._socket = self._opened.__enter__()
        self.subprotocol = self._socket.subprotocol
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._opened.__exit__(kind, error, trace)

    def listen(self, *names: str) -> None:
        """Ask for channels that were told of."""
        asked = []
        for name in names:
            number = len(self._names)
            self._names[number] = name
            asked.append({"id": number, "channelId": self.channels[name]["id"]})
        self._subscribe(asked)

    def _subscribe(self, asked: list[dict[str, int]]) -> None:
        self._socket.send(json.dumps({"op": "subscribe", "subscriptions": asked}))

    def until(self, condition: Callable[[], object], timeout_s: float) -> bool:
        """Read until a condition holds; False where it does not in time."""
        deadline_s = time.monotonic() + timeout_s
        while not condition():
            left_s = deadline_s - time.monotonic()
            if left_s <= 0.0:
                return False
            try:
                self._take(self._socket.recv(timeout=min(left_s, 0.1)))
            except TimeoutError:
                continue
        return True

    def _take(self, received: str | bytes) -> None:
        if isinstance(received, bytes):
            kind, number, _ = DATA_HEAD.unpack_from(received)
            if kind == DATA:
                self.came.setdefault(self._names[number], []).append(received[DATA_HEAD.size :])
            return
        told = json.loads(received)
        if told["op"] == "serverInfo":
            self.server = told
        elif told["op"] == "advertise":
            self.channels |= {channel["topic"]: channel for channel in told["channels"]}
        elif told["op"] == "status" and told["message"].startswith(UNKNOWN):
            self._ask_again(int(told["message"].removeprefix(UNKNOWN)))

    def _ask_again(self, channel_id: int) -> None:
        refused = {name for name, channel in self.channels.items() if channel["id"] == channel_id}
        self._subscribe(
            [
                {"id": number, "channelId": channel_id}
                for number, name in self._names.items()
                if name in refused
            ]
        )
