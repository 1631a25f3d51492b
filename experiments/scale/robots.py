"""Robots against load: many robots ask one feature service, or several that share them.

Real processes on a real bus. Each robot sends rendered frames and, as soon as it has the features of one,
asks which of the nodes around that frame it shows, as on a way.
"""

import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.bench.resources import processors_s
from experiments.bench.stages import percentiles
from experiments.rendered.features import as_message
from experiments.scale.asking_robot import ASK_S, MAP_NAME, AskingRobot, View, views_of
from experiments.scale.frames import Seen, WorldFrames
from services.features.pipeline.named_pipelines import find_profile
from services.launcher.client.failure import ExperimentError
from services.launcher.compose.compose_file import COMPOSE_FILE
from services.launcher.processes.process import ChildProcess, stop_all
from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.output import rounded
from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import AddNode, MapRequest, Node
from shared.topics import MAP

START_S, GRACE_S = 120.0, 5.0
"""As of the launcher: for all to come up, and for each to end."""

Row = dict[str, Any]


@dataclass(frozen=True)
class Load:
    """How many robots ask how many feature services, and how often each at most; 0: as fast as answered."""

    robots: int
    services: int
    rate_hz: float = 0.0


@dataclass(frozen=True)
class Work:
    """What every load is measured with.

    Attributes:
        frames: nodes of the map and pictures beside them, of one world.
        pipeline: name of the feature pipeline.
        folder: for the map and the logs.
        during_s: how long each load lasts.
    """

    frames: WorldFrames
    pipeline: str
    folder: Path
    during_s: float


def measure_loads(loads: Sequence[Load], work: Work, tick: Callable[[str], None]) -> Iterator[Row]:
    """One row for each load; latency is from a frame to the answer about its nodes; `tick` hears of each.

    Raises:
        ExperimentError: a feature service does not come up, or answers nothing.
    """
    tick("pictures for the robots")
    views = views_of(work.frames)
    with Launcher(work.folder, only=["map-store"]) as launcher, open_bus(launcher.endpoint) as bus:
        _fill(bus, work.frames.nodes, work.pipeline)
        for load in loads:
            tick(f"{load.robots} robots on {load.services} feature services")
            yield _measure(load, work, launcher, bus, views)


def _measure(load: Load, work: Work, launcher: Launcher, bus: Bus, views: Sequence[View]) -> Row:
    names = [f"r{number}" for number in range(load.robots)]
    shards = [names[number :: load.services] for number in range(load.services)]
    with _services(shards, launcher, bus, work.pipeline) as pids, ThreadPoolExecutor(load.robots) as threads:
        robots = [AskingRobot(bus, name, views) for name in names]
        for robot in robots:
            robot.step()  # the service meets it and reads the map
        stop, before_s, start_s = threading.Event(), processors_s(pids), time.monotonic()
        driving = [threads.submit(r.drive, stop, load.rate_hz, n / len(robots)) for n, r in enumerate(robots)]
        try:
            stop.wait(work.during_s)
            spent_s, wall_s = processors_s(pids) - before_s, time.monotonic() - start_s
            waits_ms = [ms for robot in robots for ms in tuple(robot.waits_ms)]
        finally:
            stop.set()
        for each in driving:
            each.result()
    if not waits_ms:
        raise ExperimentError(
            f"{load}: no frame was answered within {work.during_s:.0f} s, see {launcher.logs}"
        )
    return {
        "robots": load.robots,
        "services": load.services,
        "rate_hz": load.rate_hz,
        "frames_per_s": rounded(len(waits_ms) / wall_s, 2),
        **percentiles(waits_ms, 1),
        "cpu_ms_per_frame": rounded(1e3 * spent_s / len(waits_ms), 1),
    }


@contextmanager
def _services(
    shards: Sequence[Sequence[str]], launcher: Launcher, bus: Bus, pipeline: str
) -> Iterator[list[int]]:
    """A feature service for each shard of the robots; gives their process ids."""
    environment = {"TOPNAV_ENDPOINT": launcher.endpoint, "FEATURES_PIPELINE": pipeline}
    command, root = [sys.executable, "-m", "services.features"], COMPOSE_FILE.resolve().parent
    children = [
        ChildProcess(
            command,
            {**environment, "FEATURES_ROBOTS": ",".join(names)},
            launcher.logs / f"features-{n}.jsonl",
            root,
        )
        for n, names in enumerate(shards)
    ]
    try:
        if not wait_until(lambda: len(bus.alive("features")) == len(shards), START_S, 0.2):
            raise ExperimentError(f"{len(shards)} feature services did not come up, see {launcher.logs}")
        yield [child.pid for child in children]
    finally:
        stop_all(dict.fromkeys(children, GRACE_S))


def _fill(bus: Bus, nodes: Sequence[Seen], pipeline: str) -> None:
    """Put the nodes into a map of the map store."""
    identity = find_profile(pipeline).identity
    operations = tuple(
        AddNode(node=Node(node_id=number, pipeline=identity), features=as_message(node.features, identity))
        for number, node in enumerate(nodes)
    )
    bus.ask(MAP, MapRequest(action="create"), ASK_S, map=MAP_NAME)
    bus.ask(MAP, MapRequest(action="transact", operations=operations), ASK_S, map=MAP_NAME)
