"""`python -m tests.faults.stop_latency --kills 100`: how soon the wheels stand when something dies or hangs.

The robot explores in real time. At random instants while it drives a random service is killed (SIGKILL) or
frozen (SIGSTOP, for a few seconds). Its true speed is sampled at 20 Hz.
"""

import argparse
import contextlib
import json
import os
import signal
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from services.launcher.client.experimenter import Experimenter
from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.processes.wait import LaunchError
from shared.bus import wait_until
from shared.messages.missions import MissionRequest
from shared.queries import QueryError
from shared.topics import MISSION
from tests.faults.watching import STILL_MPS, Watch

SERVICES = ("planner", "features", "drive", "map-store", "gateway", "router")
SMALL_PICTURES = {"SIMULATOR_WIDTH_PX": "512", "SIMULATOR_RANGE_RATE_HZ": "20"}
MISSION_STEPS = 100_000
FROZEN_S = (1.0, 4.0)
WATCHED_S = 3.0
PATIENCE_S = 60.0
FIGURES = (
    "commanded_zero_s",
    "still_s",
    "zero_after_heading_s",
    "still_after_heading_s",
    "ran_on_s",
    "oldest_frame_s",
)
EVENTS_PER_MAP = 25
"""A new map begins then: comparing with many places takes longer."""


@dataclass(frozen=True)
class Event:
    """One service that was harmed while the robot drove; None where the robot never stopped.

    Attributes:
        commanded_zero_s: from the event until drive, or the robot's own watchdog, told the wheels to stand.
        still_s: from the event to the first true state at rest.
        zero_after_heading_s: to that command from the last heading before it; None if they stood already.
        still_after_heading_s: to that state from the last heading that came before it.
        ran_on_s: longest time the robot still moved after a heading, with none in between.
        oldest_frame_s: age of the oldest frame whose command still turned the wheels.
    """

    service: str
    harm: str
    commanded_zero_s: float | None
    still_s: float | None
    zero_after_heading_s: float | None
    still_after_heading_s: float | None
    ran_on_s: float
    oldest_frame_s: float


def harm(stack: Stack, watch: Watch, service: str, rng: np.random.Generator) -> Event:
    """Kill or freeze one service now and see what the wheels do."""
    launcher, frozen = stack.launcher, bool(rng.random() < 0.5)
    assert launcher is not None
    at_s = time.monotonic()
    pid = launcher.kill(service, signal.SIGSTOP if frozen else signal.SIGKILL)
    if frozen:
        time.sleep(rng.uniform(*FROZEN_S))
        with contextlib.suppress(LaunchError):
            launcher.kill(service, signal.SIGCONT)
    else:
        time.sleep(WATCHED_S)
    event = judge(watch, service, "frozen" if frozen else "killed", at_s, at_s + WATCHED_S)
    with contextlib.suppress(LaunchError):
        launcher.wait_healthy(service, PATIENCE_S, other_than=None if frozen else pid)
    return event


def judge(watch: Watch, service: str, name: str, at_s: float, until_s: float) -> Event:
    """What happened between two times."""
    stills = [t for t, mps in watch.speeds if at_s <= t <= until_s and mps < STILL_MPS]
    zero_s, still_s = watch.told_to_stand_s(at_s), stills[0] if stills else None
    zero_s = None if zero_s is not None and zero_s > until_s else zero_s
    return Event(
        service,
        name,
        _since(at_s, zero_s),
        _since(at_s, still_s),
        _since(_last(watch.arrivals["planner"], zero_s), zero_s) if zero_s != at_s else None,
        _since(_last(watch.arrivals["planner"], still_s), still_s),
        round(watch.ran_on_s(at_s), 3),
        round(watch.oldest_answer_s(at_s), 3),
    )


def play(stack: Stack, kills: int, seed: int, tell: Any) -> dict[str, Any]:
    """Harm `kills` services one after the other."""
    rng, events = np.random.default_rng(seed), list[Event]()
    while len(events) < kills:
        explore(stack, f"latency-{len(events)}", seed)
        with Watch(stack.endpoint, stack.robot) as watch:
            for _ in range(min(EVENTS_PER_MAP, kills - len(events))):
                if not wait_until(lambda: drives(stack, watch, seed), PATIENCE_S, 0.1):
                    break
                time.sleep(rng.uniform(0.0, 1.0))
                if watch.moving():
                    events.append(harm(stack, watch, str(rng.choice(SERVICES)), rng))
                    tell(figures(events))
    return figures(events)


def explore(stack: Stack, name: str, seed: int) -> None:
    """Have the robot explore from the world's start, whatever it did before."""

    def begun() -> bool:
        with contextlib.suppress(QueryError):
            ask(stack, action="cancel")
        with contextlib.suppress(QueryError):
            return ask(stack, action="explore", map=name, seed=seed, max_steps=MISSION_STEPS) is not None
        return False

    Experimenter(stack.bus, stack.robot).reset(seed)
    assert wait_until(begun, PATIENCE_S, 0.5), "the planner takes no mission"


def drives(stack: Stack, watch: Watch, seed: int) -> bool:
    """Whether the robot moves now; a mission that ended is followed by another."""
    if watch.moving():
        return True
    with contextlib.suppress(QueryError):
        if ask(stack, action="status").state not in ("running", "paused"):
            explore(stack, f"latency-{time.monotonic_ns()}", seed)
    return False


def ask(stack: Stack, **request: Any) -> Any:
    """Ask the planner."""
    return stack.bus.ask(MISSION, MissionRequest(**request), 5.0, robot=stack.robot)


def figures(events: list[Event]) -> dict[str, Any]:
    """Of all events, and of each service."""
    by_service = {name: _told([e for e in events if e.service == name]) for name in SERVICES}
    return {
        **_told(events),
        "load": [round(value, 2) for value in os.getloadavg()],
        "by_service": by_service,
        "each": [asdict(event) for event in events],
    }


def _told(events: list[Event]) -> dict[str, Any]:
    told: dict[str, Any] = {"events": len(events), "stopped": sum(e.still_s is not None for e in events)}
    for name in FIGURES:
        values = [value for event in events if (value := getattr(event, name)) is not None]
        if values:
            told[f"{name[:-2]}_p50_s"] = round(float(np.median(values)), 3)
            told[f"{name[:-2]}_p99_s"] = round(float(np.percentile(values, 99)), 3)
            told[f"{name[:-2]}_max_s"] = round(max(values), 3)
    return told


def _last(times_s: list[float], until_s: float | None) -> float | None:
    return max((t for t in times_s if until_s is not None and t <= until_s), default=None)


def _since(start_s: float | None, end_s: float | None) -> float | None:
    return None if start_s is None or end_s is None else round(end_s - start_s, 3)


def main(arguments: list[str] | None = None) -> int:
    """Run it, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--world", default="apartment")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args(arguments)

    def tell(so_far: dict[str, Any]) -> None:
        sys.stderr.write(f"{so_far['events']} of {chosen.kills}: {so_far['each'][-1]}\n")
        if chosen.json:
            chosen.json.write_text(json.dumps({"seed": chosen.seed, **so_far}, indent=2) + "\n", "utf-8")

    with tempfile.TemporaryDirectory() as folder:
        choice = StackChoice(
            Path(folder), chosen.world, chosen.seed, lockstep=False, environment=SMALL_PICTURES
        )
        with open_stack(choice) as stack:
            result = play(stack, chosen.kills, chosen.seed, tell)
    del result["each"]
    sys.stdout.write(json.dumps(result, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
