"""All tables of `topnav study scale`, one after the other."""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from experiments.bench.resources import machine
from experiments.rendered.features import Tick
from experiments.scale.frames import WorldFrames, frames_of
from experiments.scale.packing_loss import packing_losses
from experiments.scale.robots import Load, Work, measure_loads
from experiments.scale.study import ScaleStudy
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from simulator.world.world_file import load_world

MAPPED = {"apartment": 100, "factory": 200, "village": 200}
FOREIGN = {"break_room": 100}
"""Worlds in the maps and outside of them, with how many pictures are taken there."""

PEER_NODES, PEER_PICTURES = 1000, 40
"""The largest map on which the slowest peer answers within a second."""

PACKED_WORLD, PACKED_PICTURES, QUICK_PACKED_PICTURES = "apartment", 20, 2
SERVICES, RATES_HZ = (1, 2), (0.0, 2.0)
"""Feature services that share the robots; frames a second of each robot, 0: as fast as they are answered."""

LOAD_S, QUICK_LOAD_S = 15.0, 3.0
"""So long each load lasts: 30 answers of a robot at 2 frames/s."""

Report = dict[str, Any]


def measure(
    counts: Sequence[int],
    fleets: Sequence[int],
    pipeline_name: str,
    seed: int,
    cache: Path,
    quick: bool,
    tick: Tick,
) -> Iterator[Report]:
    """The report as it grows.

    Args:
        counts: nodes of the maps.
        fleets: robots that ask at once.
        pipeline_name: of the features.
        seed: of all draws.
        cache: folder of rendered features.
        quick: a glimpse.
        tick: hears how far it is.
    """
    pipeline = Pipeline(find_profile(pipeline_name))
    report: Report = {"machine": machine(), "seed": seed, "points": [], "peers": [], "refusal": {}}
    report |= {"packing": [], "robots": []}

    def rendered(worlds: dict[str, int]) -> list[WorldFrames]:
        return [frames_of(name, pipeline, n, seed, cache, tick) for name, n in worlds.items()]

    frames, foreign = rendered(MAPPED), rendered(FOREIGN)
    study = ScaleStudy(pipeline, frames, [seen for each in foreign for seen in each.queries], seed)
    largest = max(counts)
    for count in counts:
        tick(f"a map of {count} nodes")
        row, kept = study.point(count)
        report["points"].append(row)
        if count == largest:
            tick(f"pictures that are not in the map of {count} nodes")
            report["refusal"] = study.refusal(kept, count)
        yield report
    tick("others on the same pictures")
    report["peers"] = study.peers(min(PEER_NODES, largest), PEER_PICTURES)
    yield report
    pictures = QUICK_PACKED_PICTURES if quick else PACKED_PICTURES
    report["packing"] = list(packing_losses(load_world(PACKED_WORLD), pictures, seed, tick))
    yield report
    loads = [Load(n, k, rate) for rate in RATES_HZ for k in SERVICES for n in fleets if n >= k]
    with tempfile.TemporaryDirectory(prefix="topnav-scale-") as folder:
        during_s = QUICK_LOAD_S if quick else LOAD_S
        for row in measure_loads(loads, Work(frames[0], pipeline_name, Path(folder), during_s), tick):
            report["robots"].append(row)
            yield report
