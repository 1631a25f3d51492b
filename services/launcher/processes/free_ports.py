"""Free TCP ports on loopback that nobody gets by chance before the service that is to listen there.

A port asked of the kernel (port 0) lies in its ephemeral range, from which it also serves connections and
Zenoh peers that are started meanwhile: one of them may take the port while the service still loads.
"""

import random
import socket
from contextlib import ExitStack
from itertools import islice
from pathlib import Path

HOST = "127.0.0.1"
EPHEMERAL_RANGE = Path("/proc/sys/net/ipv4/ip_local_port_range")
USUAL_EPHEMERAL_FIRST = 32_768  # Linux's default
FIRST = 10_240  # browsers refuse some ports below
TRIES = 200
"""Ports looked at before the kernel is asked: more than any machine has taken of so few drawn."""


def free_ports(count: int, ephemeral_range: Path = EPHEMERAL_RANGE) -> list[int]:
    """Return different ports that are free now, below the kernel's ephemeral range where there is room.

    Args:
        count: how many.
        ephemeral_range: file with the first and last port that the kernel gives away by itself.
    """
    below = range(FIRST, _ephemeral_first(ephemeral_range))
    # Stacks of one seed run side by side: drawn from the system's entropy they do not try the same ports.
    candidates = random.SystemRandom().sample(below, min(TRIES, len(below)))
    ports = list(islice(filter(is_free, candidates), count))
    with ExitStack() as held:  # the kernel gives no port twice while it is held
        while len(ports) < count:
            probe = held.enter_context(socket.socket())
            probe.bind((HOST, 0))
            ports.append(int(probe.getsockname()[1]))
    return ports


def is_free(port: int) -> bool:
    """Whether a service could listen on a port now; one that has just ended there does not count."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError:
            return False
    return True


def _ephemeral_first(path: Path) -> int:
    return int(path.read_text(encoding="ascii").split()[0]) if path.exists() else USUAL_EPHEMERAL_FIRST
