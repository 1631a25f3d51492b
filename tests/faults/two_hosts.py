"""A robot whose services are on another host: a mission over a line with delay and loss that is cut under it.

`python -m tests.faults.two_hosts --delay-s 0.1 --loss 0.02 --cuts 5 --seed 1 --json F`
"""

import argparse
import json
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from experiments.soak.network import enter_own_network
from services.launcher.client.mission import TERMINAL, MissionClient
from shared.bus import Bus
from shared.messages.features import Features
from shared.messages.missions import MissionRequest
from shared.messages.simulation import Truth
from shared.topics import FEATURES, STATUS, TRUTH, VELOCITY
from tests.faults.hosts import TwoHosts
from tests.faults.slow_link import SlowLink
from tests.faults.speedometer import speeds_in

MAP, ROBOT = "flat", "r1"
MOVING_MPS, STILL_MPS = 0.1, 0.03
CUT_S, BETWEEN_S = 3.0, 6.0
"""A cut lasts longer than a heading, a command and the lease of a session do."""
MISSION_S = 400.0
NO_NETWORK = "this user may not have a network of its own"


@dataclass
class Report:
    """What was seen.

    Attributes:
        frame_age_s: median age of a frame when the planner's host has its features.
        still_after_s: for each cut the time until the robot stood; None when it did not while it lasted.
        moving_after_s: for each cut the time from its end until the robot drove again.
    """

    delay_s: float
    loss: float
    frames_per_s: float = 0.0
    frame_age_s: float = 0.0
    commands_per_s: float = 0.0
    way_m: float = 0.0
    mission: str = ""
    mission_s: float = 0.0
    collisions: int = 0
    still_after_s: list[float | None] = field(default_factory=list)
    moving_after_s: list[float | None] = field(default_factory=list)


def explore(bus: Bus, during_s: float, report: Report) -> Features:
    """Explore for a while; returns what the robot saw after a third of it."""
    client = MissionClient(bus, ROBOT)
    features = bus.subscribe(FEATURES, robot=ROBOT)
    commands = bus.subscribe(VELOCITY, robot=ROBOT)
    truths = bus.subscribe(TRUTH, robot=ROBOT)
    client.wait_for_frame(0)
    client.ask(MissionRequest(action="explore", map=MAP, seed=1))
    began_s, goal = time.monotonic(), None
    ages_s: list[float] = []
    way: list[Truth] = []
    answers = 0
    while time.monotonic() - began_s < during_s or goal is None:
        bus.wait(0.2)
        for seen in features.take_all():
            ages_s.append(time.time() - seen.stamp_ns / 1e9)
            if goal is None and time.monotonic() - began_s > during_s / 3:
                goal = seen
        answers += len(commands.take_all())
        way += truths.take_all()
    client.ask(MissionRequest(action="cancel"))
    report.frames_per_s, report.frame_age_s = len(ages_s) / during_s, float(np.median(ages_s))
    report.commands_per_s = answers / during_s
    places = np.array([(truth.pose.x_m, truth.pose.y_m) for truth in way])
    report.way_m = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    return goal


def find(bus: Bus, line: SlowLink, speeds_file: Path, goal: Features, cuts: int, report: Report) -> None:
    """Drive to the goal, and cut the line so often while the robot moves."""
    client = MissionClient(bus, ROBOT)
    statuses = bus.subscribe(STATUS, robot=ROBOT)
    status = client.ask(MissionRequest(action="goto", map=MAP, goal=goal, seed=1))
    began_s, next_cut_s = time.monotonic(), 0.0
    spans: list[tuple[float, float]] = []
    while status.state not in TERMINAL and time.monotonic() - began_s < MISSION_S:
        bus.wait(0.1)
        status = next(
            (one for one in reversed(statuses.take_all()) if one.mission_id == status.mission_id), status
        )
        due = len(spans) < cuts and time.monotonic() > next_cut_s
        if due and speeds_in(speeds_file)[-1][1] > MOVING_MPS:
            line.cut()
            cut_s = time.time()
            time.sleep(CUT_S)
            line.heal()
            spans.append((cut_s, time.time()))
            next_cut_s = time.monotonic() + BETWEEN_S
    report.mission, report.mission_s = status.state, time.monotonic() - began_s
    speeds = speeds_in(speeds_file)
    for cut_s, healed_s in spans:
        still = (at_s - cut_s for at_s, mps in speeds if cut_s <= at_s < healed_s and mps < STILL_MPS)
        moving = (at_s - healed_s for at_s, mps in speeds if at_s > healed_s and mps > MOVING_MPS)
        report.still_after_s.append(next(still, None))
        report.moving_after_s.append(next(moving, None))


def main() -> None:
    """Print the report; exits with 1 where the mission did not end well."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--delay-s", type=float, default=0.1)
    parser.add_argument("--loss", type=float, default=0.02)
    parser.add_argument("--explore-s", type=float, default=60.0)
    parser.add_argument("--cuts", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="kept: certificates, logs, maps")
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    if not enter_own_network():
        sys.exit(NO_NETWORK)
    report = Report(chosen.delay_s, chosen.loss)
    with tempfile.TemporaryDirectory() as spare:
        folder = chosen.folder or Path(spare)
        folder.mkdir(parents=True, exist_ok=True)
        with (
            SlowLink(chosen.delay_s, chosen.loss, np.random.default_rng(chosen.seed)) as line,
            TwoHosts(folder, line) as hosts,
        ):
            with hosts.operator() as bus:
                goal = explore(bus, chosen.explore_s, report)
            with hosts.operator() as bus:
                find(bus, line, hosts.speeds_file, goal, chosen.cuts, report)
    found = json.dumps(asdict(report), indent=2)
    if chosen.json:
        chosen.json.write_text(found, encoding="utf-8")
    sys.stdout.write(found + "\n")
    sys.exit(0 if report.mission == "succeeded" else 1)


if __name__ == "__main__":
    main()
