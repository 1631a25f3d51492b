"""A TCP proxy that can be cut: bytes stay where they are and arrive in one burst when it is healed.

It can also lose what comes from those that connected to it, and then the connections.
"""

import contextlib
import select
import socket
import threading
from types import TracebackType
from typing import Self

CHUNK = 65_536
PERIOD_S = 0.02
CONNECT_S = 5.0


class Proxy:
    """Forwards connections from a free port on loopback to `port`, until it is cut."""

    def __init__(self, port: int) -> None:
        self._target = ("127.0.0.1", port)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._pairs: dict[socket.socket, socket.socket] = {}
        self._near: set[socket.socket] = set()
        self._whole, self._stop = threading.Event(), threading.Event()
        self._losing = False
        self._passing = threading.Lock()  # held while something goes through: who cuts waits until it has
        self._whole.set()
        self._thread = threading.Thread(target=self._run, name="proxy")

    @property
    def endpoint(self) -> str:
        """Zenoh endpoint of the near end."""
        return f"tcp/127.0.0.1:{self._listener.getsockname()[1]}"

    def cut(self) -> None:
        """Let nothing through from the return on, in either direction, nor any new connection."""
        with self._passing:
            self._whole.clear()

    def heal(self) -> None:
        """Let everything through again, first what waited."""
        self._whole.set()

    def lose(self) -> None:
        """Throw away what comes from the near ends from now on; nobody notices yet."""
        with self._passing:
            self._losing = True

    def hang_up(self) -> None:
        """End every connection; new ones lose nothing."""
        with self._passing:
            for end in self._pairs:
                with contextlib.suppress(OSError):  # the other side may have closed it just now
                    end.shutdown(socket.SHUT_RDWR)
            self._losing = False

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._whole.set()
        self._thread.join()
        for end in (self._listener, *self._pairs):
            end.close()

    def _run(self) -> None:
        while not self._stop.is_set():
            self._whole.wait()
            ready, _, _ = select.select([self._listener, *self._pairs], [], [], PERIOD_S)
            with self._passing:
                for end in ready if self._whole.is_set() else ():
                    if end is self._listener:
                        self._accept()
                    elif end in self._pairs:
                        self._forward(end)

    def _accept(self) -> None:
        near, _ = self._listener.accept()
        try:
            far = socket.create_connection(self._target, timeout=CONNECT_S)
        except OSError:
            near.close()
            return
        far.settimeout(None)  # one that takes its time is no reason to end a connection
        self._pairs |= {near: far, far: near}
        self._near.add(near)

    def _forward(self, end: socket.socket) -> None:
        try:
            chunk = end.recv(CHUNK)
            if chunk:
                if not (self._losing and end in self._near):
                    self._pairs[end].sendall(chunk)
                return
        except OSError:
            pass
        far = self._pairs.pop(end)
        del self._pairs[far]
        self._near -= {end, far}
        end.close()
        far.close()
