"""`python -m tests.faults.short_freezes`: do processes that stood still for a lease hear each other again?

Seven processes on a plain bus, one of which sends pictures. Again and again a random one is stopped for a
while; soon after everybody must hear everybody. Who does not is replaced by a new process.
"""

import argparse
import contextlib
import json
import multiprocessing
import os
import random
import signal
import sys
import time
from collections.abc import Iterator
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Any

import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.bus import open_bus, wait_until
from shared.transport.router_config import router_config

PEERS = 7
CAMERA_BYTES, CAMERA_PERIOD_S = 1_500_000, 0.15
OTHER_BYTES, OTHER_PERIOD_S = 30_000, 0.05
SILENT_S = 0.6
MEET_S = 12.0
START_S = 60.0


def peer(number: int, port: int, heard_s: Any) -> None:
    """Send, and note when each of the others was heard last."""
    size, period_s = (CAMERA_BYTES, CAMERA_PERIOD_S) if number == 0 else (OTHER_BYTES, OTHER_PERIOD_S)

    def note(sample: zenoh.Sample) -> None:
        heard_s[number * PEERS + int(str(sample.key_expr).rpartition("/")[2])] = time.monotonic()

    with open_bus(f"tcp/127.0.0.1:{port}") as bus:
        session = bus._session
        session.declare_subscriber("freezes/*", zenoh.handlers.Callback(note, indirect=False))
        publisher = session.declare_publisher(f"freezes/{number}")
        payload = bytes(size)
        while True:
            publisher.put(payload)
            time.sleep(period_s)


class Peers:
    """The processes, and who heard whom when."""

    def __init__(self, port: int) -> None:
        self._spawn = multiprocessing.get_context("spawn")
        self._port = port
        self._heard_s = self._spawn.Array("d", PEERS * PEERS, lock=False)
        self.processes = [self._start(number) for number in range(PEERS)]

    def _start(self, number: int) -> SpawnProcess:
        process = self._spawn.Process(target=peer, args=(number, self._port, self._heard_s), daemon=True)
        process.start()
        return process

    def replace(self, number: int) -> None:
        """Kill one and start another in its place."""
        self.processes[number].kill()
        self.processes[number].join()
        self.processes[number] = self._start(number)

    def deaf(self) -> list[tuple[int, int]]:
        """Pairs of which the first has not heard the second lately."""
        now_s = time.monotonic()
        pairs = ((i, j) for i in range(PEERS) for j in range(PEERS) if i != j)
        return [(i, j) for i, j in pairs if now_s - self._heard_s[i * PEERS + j] > SILENT_S]

    def meet(self, within_s: float) -> bool:
        """Wait until everybody hears everybody."""
        return wait_until(lambda: not self.deaf(), within_s)


@contextlib.contextmanager
def running() -> Iterator[Peers]:
    """A router and its peers, killed in the end."""
    (port,) = free_ports(1)
    with zenoh.open(router_config(f"tcp/127.0.0.1:{port}")):
        peers = Peers(port)
        try:
            yield peers
        finally:
            for process in peers.processes:
                process.kill()


def freeze_often(peers: Peers, freezes: int, least_s: float, most_s: float, rng: random.Random) -> dict:
    """Stop one after the other for a while; how often somebody stayed deaf, and the slowest to meet again."""
    cut_off, slowest_s = [], 0.0
    for _ in range(freezes):
        victim, frozen_s = rng.randrange(PEERS), rng.uniform(least_s, most_s)
        pid = peers.processes[victim].pid
        os.kill(pid, signal.SIGSTOP)
        time.sleep(frozen_s)
        os.kill(pid, signal.SIGCONT)
        since_s = time.monotonic()
        time.sleep(2 * SILENT_S)  # links that go do so late; who was heard until then counts as heard
        if peers.meet(MEET_S):
            slowest_s = max(slowest_s, time.monotonic() - since_s)
        else:
            cut_off.append({"frozen_s": round(frozen_s, 2), "victim": victim, "deaf": peers.deaf()})
            peers.replace(victim)
            peers.meet(START_S)
        time.sleep(rng.uniform(0.2, 1.0))
    return {"freezes": freezes, "cut_off": cut_off, "slowest_s": round(slowest_s, 2)}


def main() -> None:
    """Freeze and report as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--freezes", type=int, default=25)
    parser.add_argument("--least-s", type=float, default=1.9)
    parser.add_argument("--most-s", type=float, default=2.4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    with running() as peers:
        if not peers.meet(START_S):
            raise SystemExit(f"processes that never heard each other: {peers.deaf()}")
        rng = random.Random(chosen.seed)
        report = freeze_often(peers, chosen.freezes, chosen.least_s, chosen.most_s, rng)
    sys.stdout.write(json.dumps(report, indent=1) + "\n")
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(report))
    raise SystemExit(1 if report["cut_off"] else 0)


if __name__ == "__main__":
    main()
