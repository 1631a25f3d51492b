"""Two hosts on one machine: network namespaces joined by a line with delay and loss, which can be cut.

Many kernels lack their own emulation of that (`tc netem`). So packets pass through a thread: both ends are
TUN devices, and what one reads the other writes a while later, or never.
"""

import ctypes
import fcntl
import heapq
import os
import select
import struct
import subprocess
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

ADDRESSES = ("10.77.0.1", "10.77.0.2")
CLONE_NEWNET = 0x40000000  # linux/sched.h
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000  # linux/if_tun.h
PACKET = 65_536
MTU = 1500
LOOPBACK = "link set dev lo up"
IDLE_S = 0.05


class SlowLink:
    """The second host and the line to it; this process is the first.

    Args:
        delay_s: of every packet, each way.
        loss: share of the packets that never arrive, each way.
        rng: decides which.
    """

    def __init__(self, delay_s: float, loss: float, rng: np.random.Generator) -> None:
        self.delay_s, self.loss, self._rng = delay_s, loss, rng
        self._cut, self._stop = threading.Event(), threading.Event()
        self._far = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        self._ends: list[int] = []
        self._thread = threading.Thread(target=self._run, name="slow-link")

    def __enter__(self) -> Self:
        while _network(self._far.pid).samefile(_network(os.getpid())):
            time.sleep(0.01)  # it has not moved out yet
        for pid, address in zip((os.getpid(), self._far.pid), ADDRESSES, strict=True):
            self._ends.append(_tun_in(pid))
            for words in (f"address add {address}/24 dev line", f"link set dev line mtu {MTU} up", LOOPBACK):
                subprocess.run(["nsenter", f"--net={_network(pid)}", "ip", *words.split()], check=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()
        for end in self._ends:
            os.close(end)
        self._far.kill()
        self._far.wait()

    def on_far_host(self, command: Sequence[str]) -> list[str]:
        """The same command, run on the second host."""
        return ["nsenter", f"--net={_network(self._far.pid)}", *command]

    def cut(self) -> None:
        """Lose everything from now on, also what is under way."""
        self._cut.set()

    def heal(self) -> None:
        """Let pass again what is sent from now on."""
        self._cut.clear()

    def _run(self) -> None:
        waiting: list[tuple[float, int, int, bytes]] = []  # when due, order, to whom, packet
        sent = 0
        while not self._stop.is_set():
            pause_s = max(0.0, waiting[0][0] - time.monotonic()) if waiting else IDLE_S
            ready, _, _ = select.select(self._ends, [], [], min(pause_s, IDLE_S))
            for end in ready:
                packet, sent = os.read(end, PACKET), sent + 1
                if self._rng.random() >= self.loss:
                    far = self._ends[1 - self._ends.index(end)]
                    heapq.heappush(waiting, (time.monotonic() + self.delay_s, sent, far, packet))
            while waiting and waiting[0][0] <= time.monotonic():
                _, _, far, packet = heapq.heappop(waiting)
                if not self._cut.is_set():
                    os.write(far, packet)


def _network(pid: int) -> Path:
    return Path(f"/proc/{pid}/ns/net")


def _tun_in(pid: int) -> int:
    """A TUN device named "line" in the network of a process. A thread may visit another network by itself."""
    found: list[Any] = []

    def make() -> None:
        libc = ctypes.CDLL(None, use_errno=True)
        try:
            with _network(pid).open("rb") as network:
                if libc.setns(network.fileno(), CLONE_NEWNET) != 0:
                    raise OSError(ctypes.get_errno(), f"cannot enter the network of process {pid}")
            end = os.open("/dev/net/tun", os.O_RDWR | os.O_CLOEXEC)
            fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH22x", b"line", IFF_TUN | IFF_NO_PI))
            found.append(end)
        except OSError as error:
            found.append(error)

    visitor = threading.Thread(target=make)
    visitor.start()
    visitor.join()
    if isinstance(found[0], OSError):
        raise found[0]
    return int(found[0])
