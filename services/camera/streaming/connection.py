"""One HTTP request whose answer may never end: every wait has an end, and so has every line.

`http.client` bounds lines and headers; timeouts of a socket it has for each single read, so a server that
sends a byte a second could hold it for days. Here a deadline counts for all reads until the next one is set.
"""

import http.client
import io
import socket
import ssl
import threading
import time
from dataclasses import dataclass
from typing import Any, Self

from services.camera.camera_url import CameraUrl
from services.camera.source import SourceError
from services.camera.streaming.authorization import authorization

CONNECT_S = 3.0
"""Chosen: a camera in the same network answers within milliseconds, one that wakes up takes a second."""
SLICE_S = 0.2
"""How soon a reader notices that it is to stop; chosen."""
BROKEN = (OSError, http.client.HTTPException, ssl.SSLError)


class StoppedError(SourceError):
    """The service is to end."""


class _DeadlineIO(io.RawIOBase):
    """Reads of a socket until a deadline on the monotonic clock, or until `stop`."""

    def __init__(self, sock: socket.socket, stop: threading.Event) -> None:
        self._sock, self._stop = sock, stop
        self.deadline_s = time.monotonic() + CONNECT_S

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        while not self._stop.is_set():
            left_s = self.deadline_s - time.monotonic()
            if left_s <= 0.0:
                raise TimeoutError("timed out")
            self._sock.settimeout(min(left_s, SLICE_S))
            try:
                return self._sock.recv_into(buffer)
            except TimeoutError:
                continue
        raise StoppedError("stopped")


class _TimedSocket:
    """What `http.client` needs of a socket; the socket outlives the connection, as answers do."""

    def __init__(self, sock: socket.socket, stop: threading.Event) -> None:
        self.sock, self.reader = sock, _DeadlineIO(sock, stop)

    def sendall(self, data: Any) -> None:
        self.sock.settimeout(CONNECT_S)
        self.sock.sendall(data)

    def makefile(self, *_: Any, **__: Any) -> io.BufferedReader:
        return io.BufferedReader(self.reader)

    def close(self) -> None:
        """Nothing: `Answer.close` closes it."""


@dataclass(frozen=True)
class Request:
    """What is asked of a server."""

    method: str
    path: str
    body: bytes | None = None
    headers: tuple[tuple[str, str], ...] = ()


class Answer:
    """A server's answer, read by and by."""

    def __init__(self, response: http.client.HTTPResponse, timed: _TimedSocket) -> None:
        self._response, self._timed = response, timed
        self.status = response.status
        self.content_type = response.headers.get("Content-Type", "")
        self.challenge = response.headers.get("WWW-Authenticate", "")

    def allow(self, seconds: float) -> None:
        """Let everything that is read from now on take so long in all."""
        self._timed.reader.deadline_s = time.monotonic() + seconds

    def read(self, count: int) -> bytes:
        """Read `count` bytes, fewer at the end of the answer.

        Raises:
            SourceError: not in time, or the connection broke.
        """
        try:
            return self._response.read(count)
        except http.client.IncompleteRead as error:
            return error.partial
        except BROKEN as error:
            raise SourceError(told(error)) from error

    def readline(self, most: int) -> bytes:
        """Read up to the next end of a line, at most `most` bytes; empty at the end of the answer.

        Raises:
            SourceError: as for `read`.
        """
        try:
            return self._response.readline(most)
        except BROKEN as error:
            raise SourceError(told(error)) from error

    def close(self) -> None:
        """Close the connection."""
        self._timed.sock.close()

    def __enter__(self) -> Self:
        """Nothing to do."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()


def ask(url: CameraUrl, request: Request, stop: threading.Event, patience_s: float) -> Answer:
    """Send a request; with user and password where the server asks for them.

    Args:
        url: host, port, and who asks.
        request: what to ask.
        stop: ends the wait.
        patience_s: how long the head of the answer may take.

    Raises:
        SourceError: no connection, no answer in time, or no HTTP.
    """
    answer = _asked(url, request, stop, patience_s, ())
    if answer.status == 401 and url.user:
        answer.close()
        proof = authorization(answer.challenge, url, request.method, request.path)
        answer = _asked(url, request, stop, patience_s, (("Authorization", proof),))
    return answer


def _asked(
    url: CameraUrl, request: Request, stop: threading.Event, patience_s: float, proof: tuple[Any, ...]
) -> Answer:
    secure = url.scheme == "https"
    make = http.client.HTTPSConnection if secure else http.client.HTTPConnection
    connection = make(url.host, url.port, timeout=CONNECT_S)
    try:
        connection.connect()
        timed = _TimedSocket(connection.sock, stop)
    except BROKEN as error:
        connection.close()
        raise SourceError(f"no connection: {told(error)}") from error
    connection.sock = timed
    timed.reader.deadline_s = time.monotonic() + patience_s
    try:
        connection.request(request.method, request.path, request.body, dict((*request.headers, *proof)))
        return Answer(connection.getresponse(), timed)
    except (*BROKEN, SourceError, ValueError) as error:
        timed.sock.close()
        if isinstance(error, SourceError):
            raise
        raise SourceError(f"no answer to {request.method} {request.path[:80]}: {told(error)}") from error


def told(error: BaseException) -> str:
    """One short line about an exception."""
    text = " ".join(str(error).split())[:160]
    return text or type(error).__name__
