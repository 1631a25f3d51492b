"""Pairs of frames of a recording: the robot's own commands tell how they lie to each other.

A robot that drove nearly straight from one frame to the next lies where its commands say, to 20 % and some
degrees (`shared.motion.reckoning`); of a winding way nothing is known. No position is asked for.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from experiments.calibration.measuring import measured
from experiments.calibration.thresholds import Pair
from experiments.rendered.features import Tick
from services.features.matching.verification import feature_set
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError
from services.recorder.channels import topic_of
from services.recorder.reading import read
from shared import topics
from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.messages.sensors import Frame, Ranges
from shared.motion.motion import NO_MOTION, Motion, rotated
from shared.motion.reckoning import Reckoning
from shared.topics import Topic
from shared.wire import decode

STRAIGHT = 1.1
"""A way this many times as long as the line between its ends bends by 25 degrees on the whole, and its
commands, good to 15 %, miss the direction by 10."""


@dataclass(frozen=True)
class Stop:
    """A frame and where the robot was, by its commands since the first one.

    Attributes:
        number: of the frame in the recording.
        position_m: (2,) and yaw_rad: in the frame of the first.
        driven_m: length of the way so far.
    """

    number: int
    position_m: tuple[float, float]
    driven_m: float
    yaw_rad: float = 0.0


def pairs_of_recording(
    path: Path, pipeline: Pipeline, count: int, seed: int, apart_m: tuple[float, float], tick: Tick
) -> list[Pair]:
    """Up to `count` pairs of frames so far apart between which the robot drove nearly straight.

    Args:
        path: a finished recording with frames and commands of one robot.
        pipeline: to measure.
        count: of pairs.
        seed: draws the pairs, and for verification.
        apart_m: least and most distance.
        tick: hears how far it is.

    Raises:
        ExperimentError: it holds no such pair.
        RecordingError: no recording, or a broken one.
    """
    stops = stops_of(path)
    chosen = straight_pairs(stops, count, apart_m, np.random.default_rng(seed))
    if not chosen:
        raise ExperimentError(
            f"{path}: expected frames {apart_m[0]} to {apart_m[1]} m apart on a straight way, got "
            f"{len(stops)} frames and none: record a drive with its frames and commands (topnav record)"
        )
    features = _features(path, {stop.number for pair in chosen for stop in pair}, pipeline, tick)
    found = []
    for number, (here, there) in enumerate(chosen, start=1):
        tick(f"pair {number} of {len(chosen)}")
        away_x_m, away_y_m = np.subtract(there.position_m, here.position_m)
        x_m, y_m = rotated(float(away_x_m), float(away_y_m), -here.yaw_rad)
        distance_m, bearing_rad = math.hypot(x_m, y_m), math.atan2(y_m, x_m)
        both = features[here.number], features[there.number]
        found.append(measured(*both, bearing_rad, distance_m, pipeline, seed + number))
    return found


def stops_of(path: Path) -> list[Stop]:
    """Where every frame was taken, by odometry or commands."""
    reckoning, step_s = Reckoning(), None
    stamp_ns = 0
    stops: list[Stop] = []
    for topic, payload in _of_one_robot(path):
        if topic is topics.FRAME:
            frame = decode(Frame, payload, topic.max_bytes)
            moved = reckoning.between(stamp_ns, frame.stamp_ns) if stops else NO_MOTION
            stops.append(_next(stops, moved))
            stamp_ns = frame.stamp_ns
        elif topic is topics.RANGES:
            step_s = decode(Ranges, payload, topic.max_bytes).step_s
        elif topic is topics.VELOCITY:
            velocity = decode(Velocity, payload, topic.max_bytes)
            reckoning.told(velocity, None if step_s is None else max(step_s, 1e-3 * velocity.ttl_ms))
        elif topic is topics.ODOMETRY:
            reckoning.measured(decode(Odometry, payload, topic.max_bytes))
    return stops


def straight_pairs(
    stops: list[Stop], count: int, apart_m: tuple[float, float], rng: np.random.Generator
) -> list[tuple[Stop, Stop]]:
    """Pairs drawn of all that lie so far apart and have a nearly straight way between them."""
    found = []
    for number, here in enumerate(stops):
        for there in stops[number + 1 :]:
            driven_m = there.driven_m - here.driven_m
            if driven_m > STRAIGHT * apart_m[1]:
                break
            distance_m = math.dist(here.position_m, there.position_m)
            if distance_m >= apart_m[0] and driven_m <= STRAIGHT * min(distance_m, apart_m[1]):
                found.append((here, there))
    if len(found) <= count:
        return found
    return [found[n] for n in np.sort(rng.choice(len(found), count, replace=False))]


def _next(stops: list[Stop], moved: Motion) -> Stop:
    if not stops:
        return Stop(0, (0.0, 0.0), 0.0)
    last = stops[-1]
    there = Motion(*last.position_m, last.yaw_rad).then(moved)
    return Stop(len(stops), (there.x_m, there.y_m), last.driven_m + moved.way_m, there.turn_rad)


def _features(path: Path, wanted: set[int], pipeline: Pipeline, tick: Tick) -> dict[int, FeatureSet]:
    """Features of the wanted frames; the file is read again, so that no pictures are kept."""
    found: dict[int, FeatureSet] = {}
    frames = (payload for topic, payload in _of_one_robot(path) if topic is topics.FRAME)
    for number, payload in enumerate(frames):
        if number in wanted:
            tick(f"frame {len(found) + 1} of {len(wanted)}")
            frame = decode(Frame, payload, topics.FRAME.max_bytes)
            found[number] = feature_set(pipeline.features_of(frame))
    return found


def _of_one_robot(path: Path) -> Iterator[tuple[Topic[Any], bytes]]:
    """What the robot of the first frame sent and was told, from there on."""
    robot = None
    for sample in read(path):
        topic, names = topic_of(sample.key) or (None, {})
        if robot is None and topic is topics.FRAME:
            robot = names["robot"]
        if topic is not None and robot is not None and names.get("robot") == robot:
            yield topic, sample.payload
