"""Cameras that stream over HTTP (Motion JPEG) or RTSP (JPEG in RTP, RFC 2435), with a delay of their own."""

import contextlib
import socketserver
import struct
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler
from typing import Any, Self

Pictures = Callable[[float], bytes]
"""The JPEG that is exposed at a time, monotonic seconds."""

PIECE = 1_400
"""Bytes of a picture in one RTP packet."""
SDP = "v=0\r\no=- 0 0 IN IP4 127.0.0.1\r\ns=camera\r\nt=0 0\r\nm=video 0 RTP/AVP 26\r\na=control:track1\r\n"


class StreamCamera(socketserver.ThreadingTCPServer):
    """A camera on a port of its own.

    Args:
        pictures: what it sees.
        rate_hz: of its pictures.
        delay_s: from exposure until a picture is sent.
        rtsp: speak RTSP; else HTTP.
    """

    allow_reuse_address = daemon_threads = True
    block_on_close = False

    def __init__(
        self, pictures: Pictures, rate_hz: float = 10.0, delay_s: float = 0.0, *, rtsp: bool = False
    ) -> None:
        super().__init__(("127.0.0.1", 0), _Rtsp if rtsp else _Http)
        self._pictures, self._rate_hz, self._delay_s = pictures, rate_hz, delay_s
        scheme, path = ("rtsp", "live") if rtsp else ("http", "video")
        self.url = f"{scheme}://127.0.0.1:{self.server_address[1]}/{path}"
        self.closed = threading.Event()

    def stream(self) -> Iterator[bytes]:
        """Pictures when they are to be sent."""
        waiting: deque[tuple[float, bytes]] = deque()
        while not self.closed.wait(1.0 / self._rate_hz):
            now_s = time.monotonic()
            waiting.append((now_s + self._delay_s, self._pictures(now_s)))
            while waiting and waiting[0][0] <= time.monotonic():
                yield waiting.popleft()[1]

    def handle_error(self, *_: Any) -> None:
        """A client that goes away is no news."""

    def __enter__(self) -> Self:
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self.closed.set()
        self.shutdown()
        self.server_close()


class _Http(BaseHTTPRequestHandler):
    server: StreamCamera

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        for jpeg in self.server.stream():
            head = b"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(jpeg)
            self.wfile.write(head + jpeg + b"\r\n")

    def log_message(self, *_: Any) -> None:
        """Nothing on standard error."""


class _Rtsp(socketserver.StreamRequestHandler):
    """Packets come in the same connection as the answers (RFC 2326, 10.12)."""

    server: StreamCamera

    def handle(self) -> None:
        while words := self.rfile.readline().split():
            headers = dict(line.split(b": ", 1) for line in iter(self.rfile.readline, b"\r\n"))
            told = {b"CSeq": headers[b"CSeq"].strip(), b"Session": b"1"}
            method, body = words[0], b""
            if method == b"OPTIONS":
                told[b"Public"] = b"DESCRIBE, SETUP, PLAY, TEARDOWN"
            elif method == b"DESCRIBE":
                body = SDP.encode()
                told |= {b"Content-Type": b"application/sdp", b"Content-Length": b"%d" % len(body)}
            elif method == b"SETUP":
                told[b"Transport"] = b"RTP/AVP/TCP;unicast;interleaved=0-1"
            lines = b"".join(name + b": " + value + b"\r\n" for name, value in told.items())
            self.wfile.write(b"RTSP/1.0 200 OK\r\n" + lines + b"\r\n" + body)
            if method == b"PLAY":
                with contextlib.suppress(OSError):
                    self._play()
                return

    def _play(self) -> None:
        number = 0
        for jpeg in self.server.stream():
            ticks = round(90_000 * time.monotonic()) & 0xFFFF_FFFF
            for packet, last in _payloads(jpeg):
                rtp = struct.pack(">BBHII", 0x80, 26 | last << 7, number & 0xFFFF, ticks, 1) + packet
                self.wfile.write(struct.pack(">cBH", b"$", 0, len(rtp)) + rtp)
                number += 1


def _payloads(jpeg: bytes) -> list[tuple[bytes, bool]]:
    """Payloads of a baseline JPEG, 4:2:0, and which is the last (RFC 2435, 3.1)."""
    tables, size, scan = b"", (0, 0), 2
    while jpeg[scan + 1] != 0xDA:
        length = int.from_bytes(jpeg[scan + 2 : scan + 4])
        segment = jpeg[scan + 4 : scan + 2 + length]
        if jpeg[scan + 1] == 0xDB:
            tables += b"".join(segment[at + 1 : at + 65] for at in range(0, len(segment), 65))
        elif jpeg[scan + 1] == 0xC0:
            size = int.from_bytes(segment[1:3]), int.from_bytes(segment[3:5])
        scan += 2 + length
    data = jpeg[scan + 2 + int.from_bytes(jpeg[scan + 2 : scan + 4]) : -2]
    found = []
    for at in range(0, len(data), PIECE):
        head = struct.pack(">IBBBB", at, 1, 255, size[1] // 8, size[0] // 8)
        head += struct.pack(">BBH", 0, 0, len(tables)) + tables if at == 0 else b""
        found.append((head + data[at : at + PIECE], at + PIECE >= len(data)))
    return found
