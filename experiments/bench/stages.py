"""From arrivals of messages to durations of the stages of the loop, and from frame to command. Pure.

    truth(k) -> features(k) -> heading(k) -> command(k) -> truth(k+1)

Truth(k) leaves the simulator together with frame k, so that
    transport = features(k) - truth(k) - extract, the way of the frame and of its features
    plan      = heading(k) - features(k) - match - verify, the planner's own work and its questions' way
    drive     = command(k) - heading(k), with the way of two messages
    simulate  = truth(k+1) - command(k) - render
Render, extract, match and verify are measured by the services themselves and travel in their messages.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from services.launcher.terminal.output import rounded
from shared.messages.base import Message
from shared.messages.drive import Heading
from shared.messages.features import Features
from shared.messages.missions import Event
from shared.messages.simulation import Truth

STAGES = ("render", "transport", "extract", "match", "verify", "plan", "drive", "simulate")


@dataclass(frozen=True)
class Arrival:
    """A message and when it came, seconds of a monotonic clock."""

    topic: str
    time_s: float
    message: Message


def stage_durations_ms(arrivals: Iterable[Arrival]) -> dict[str, list[float]]:
    """Durations of each stage over all whole cycles; a stage nobody measures stays empty."""
    cycles: dict[int, dict[str, Arrival]] = {}
    events: dict[int, Event] = {}
    for arrival in arrivals:
        if isinstance(arrival.message, Event):
            events.setdefault(arrival.message.stamp_ns, arrival.message)
        else:
            cycles.setdefault(arrival.message.seq, {}).setdefault(arrival.topic, arrival)
    found: dict[str, list[float]] = {stage: [] for stage in STAGES}
    for seq, cycle in sorted(cycles.items()):
        following = cycles.get(seq + 1, {}).get("truth")
        if len(cycle) == 4 and following is not None:
            stamp_ns = cycle["features"].message.stamp_ns
            for stage, duration_ms in _cycle(cycle, following, events.get(stamp_ns)).items():
                found[stage].append(duration_ms)
    return found


def table(durations_ms: Mapping[str, list[float]]) -> dict[str, dict[str, float]]:
    """Median and 99th percentile of each measured stage."""
    return {stage: percentiles(d) for stage, d in durations_ms.items() if d}


def percentiles(ms: Sequence[float], digits: int = 2) -> dict[str, float]:
    """Median and 99th percentile, milliseconds."""
    return {f"p{q}_ms": rounded(np.percentile(ms, q), digits) for q in (50, 99)}


def latency(arrivals: Iterable[Arrival]) -> dict[str, float]:
    """From frame to command across all processes: percentiles, and the share of frames that got a command.

    Only frames between the first and the last command count: before and after them no mission drives. Of a
    frame that is sent again, and of a command that is repeated, the first counts.
    """
    first: dict[str, dict[int, float]] = {"frame": {}, "command": {}}
    for arrival in arrivals:
        first[arrival.topic].setdefault(arrival.message.seq, arrival.time_s)
    frames, commands = first["frame"], first["command"]
    if not commands:
        return {"frames": 0}
    asked = [seq for seq in frames if min(commands) <= seq <= max(commands)]
    waits_ms = [1e3 * (commands[seq] - frames[seq]) for seq in asked if seq in commands]
    if not waits_ms:
        return {"frames": len(asked)}
    return {
        **percentiles(waits_ms),
        "frames": len(asked),
        "answered": rounded(len(waits_ms) / len(asked), 3),
    }


def _cycle(cycle: Mapping[str, Arrival], following: Arrival, event: Event | None) -> dict[str, float]:
    times = {topic: arrival.time_s * 1e3 for topic, arrival in cycle.items()}
    to_features = times["features"] - times["truth"]
    to_heading = times["heading"] - times["features"]
    # Each service is heard on a link of its own: a busy machine may bring a command before its heading.
    stages = {"drive": max(0.0, times["command"] - times["heading"])}
    extract = _own(cycle["features"].message, "extract_ms")
    stages |= {"extract": to_features} if extract is None else {"extract": extract}
    if extract is not None:
        stages["transport"] = max(0.0, to_features - extract)
    asked = {stage: _own(cycle["heading"].message, f"{stage}_ms", event) for stage in ("match", "verify")}
    measured = {stage: value for stage, value in asked.items() if value is not None}
    stages |= measured | {"plan": max(0.0, to_heading - sum(measured.values()))}
    truth = following.message
    if isinstance(truth, Truth):
        stages["render"] = truth.render_ms
        stages["simulate"] = max(0.0, following.time_s * 1e3 - times["command"] - truth.render_ms)
    return stages


def _own(message: Message, name: str, event: Event | None = None) -> float | None:
    """A duration that a service measured itself, from its message or its event."""
    if isinstance(message, Features | Heading) and getattr(message, name, None):
        return float(getattr(message, name))
    values = {value.name: value.value for value in event.values} if event is not None else {}
    found = values.get(name)
    return float(found) if isinstance(found, int | float) else None
