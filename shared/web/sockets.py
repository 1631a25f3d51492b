"""WebSockets whose readers have next to nothing to say: no flood of tiny frames may hold up everybody else.

uvicorn limits the bytes of one message and nothing more. All frames of one read are taken apart at once on
the loop that answers the emergency stop as well, and each ping is answered however full the buffer is.
"""

from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import CloseCode

BURST_BYTES = 2048
"""Chosen: taken apart in a few milliseconds, even as 340 frames of 6 bytes."""
BYTES_PER_S = 256
"""Chosen: pongs, pings and a farewell are a few bytes every 20 s."""
FAREWELL_S = 1.0
"""Chosen: how long the reason may take to be read."""


class SparingSocketProtocol(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket; a reader that says more than these bounds is told so and cut off."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._allowed, self._since_s = float(BURST_BYTES), self.loop.time()
        self._ended = False

    def data_received(self, data: bytes) -> None:
        """Pass on what came; the handshake comes first, in one piece, and counts for nothing."""
        if self._ended:
            return
        if self.handshake_initiated and not self._allows(len(data)):
            self._end()
            return
        super().data_received(data)

    def _allows(self, length: int) -> bool:
        now_s = self.loop.time()
        earned = (now_s - self._since_s) * BYTES_PER_S
        self._allowed, self._since_s = min(float(BURST_BYTES), self._allowed + earned) - length, now_s
        return self._allowed >= 0.0

    def _end(self) -> None:
        self._ended = True
        if self.handshake_complete and not self.close_sent:
            self.conn.send_close(CloseCode.POLICY_VIOLATION, "nothing is expected of a reader")
            self.transport.write(b"".join(self.conn.data_to_send()))
        self.transport.close()
        self.loop.call_later(FAREWELL_S, self.transport.abort)  # whoever does not read it
