"""`python -m tests.faults.rogue ENDPOINT flood MB_PER_S | sleep`: harms the bus, or sleeps on it."""

import sys
import time

import zenoh

from shared.transport.session_config import peer_config

JUNK = bytes(range(256)) * 200
KEYS = (
    "heading", "ranges", "standing", "velocity", "manual", "frame", "camera", "features", "odometry", "imu",
    "battery", "status", "event", "stopped",
)  # fmt: skip
NAP_S = 0.5


def flood(session: zenoh.Session, mb_per_s: float) -> None:
    """Junk of 51 kB on every topic of robot r1, until killed; prints what it sent each second."""
    pause_s = len(JUNK) / (mb_per_s * 1e6)
    began_s, sent = time.monotonic(), 0
    while True:
        session.put(f"topnav/r1/{KEYS[sent % len(KEYS)]}", JUNK)
        sent += 1
        ahead_s = began_s + sent * pause_s - time.monotonic()
        if ahead_s > 0.001:
            time.sleep(ahead_s)
        if sent % 1_000 == 0:
            rate = sent * len(JUNK) / 1e6 / (time.monotonic() - began_s)
            sys.stdout.write(f"{rate:.1f}\n")
            sys.stdout.flush()


def sleep(session: zenoh.Session) -> None:
    """Subscribe to everything of robot r1 and sleep half a second on each message."""
    fifo = session.declare_subscriber("topnav/r1/**", zenoh.handlers.FifoChannel(1))
    sys.stdout.write("asleep\n")
    sys.stdout.flush()
    while True:
        fifo.recv()
        time.sleep(NAP_S)


def main(endpoint: str, what: str, *figures: str) -> None:
    """Join the bus and do it."""
    with zenoh.open(peer_config(endpoint)) as session:
        flood(session, *map(float, figures)) if what == "flood" else sleep(session)


if __name__ == "__main__":
    main(*sys.argv[1:])
