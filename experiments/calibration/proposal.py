"""Thresholds from tours, a recording or a world."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.calibration.measuring import of_rendering
from experiments.calibration.recordings import pairs_of_recording
from experiments.calibration.thresholds import Pair, distance_rows, longest_edge_m, propose, propose_by_count
from experiments.calibration.tours import pairs_of_tours
from experiments.photographs.tours import read_tours
from experiments.rendered.features import Tick
from experiments.rendered.headings import measure
from experiments.rendered.tables import distance_table
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.environments import INDOOR, Spans
from services.launcher.client.failure import ExperimentError
from services.planner.profiles import Profile
from simulator.world.world_file import load_world


@dataclass(frozen=True)
class Asked:
    """What is calibrated.

    Attributes:
        pipeline: whose matches are counted.
        rules: all others, and whether S is of verified matches.
        spans: distances between nodes.
        count: of pairs, where they are drawn.
        seed: of every draw.
        tick: hears how far it is.
    """

    pipeline: Pipeline
    rules: Profile
    spans: Spans
    count: int
    seed: int
    tick: Tick

    def require_verified(self) -> None:
        """Rules that stop by the count of matches need pairs of known distances.

        Raises:
            ExperimentError: these are such rules.
        """
        if self.rules.sensing.similarity == "raw":
            raise ExperimentError(
                f"profile {self.rules.name} ends a path by the count of matches, of which photographs and "
                "drives tell too little: calibrate it in a world, without --tours and --recording"
            )


@dataclass(frozen=True)
class Proposal:
    """What was measured, and the thresholds that follow; `rows` by distance, where it is known."""

    pairs: Sequence[Pair]
    thresholds: dict[str, float]
    rows: list[dict[str, Any]]


def of_tours(asked: Asked, folder: Path) -> Proposal:
    """From linked photographs.

    Raises:
        ExperimentError: no tours, or none with a link, or rules that stop by count.
    """
    asked.require_verified()
    found, alike = pairs_of_tours(read_tours(folder), asked.pipeline, asked.rules, asked.seed, asked.tick)
    return Proposal(found, propose(found, asked.spans, doubtful=True, look_alikes=alike), [])


def of_recording(asked: Asked, path: Path) -> Proposal:
    """From a recorded drive.

    Raises:
        ExperimentError: it holds no pair of pictures, or the rules stop by count.
    """
    asked.require_verified()
    found = pairs_of_recording(path, asked.pipeline, asked.count, asked.seed, asked.spans.pair_m, asked.tick)
    return Proposal(found, propose(found, asked.spans, doubtful=True), distance_rows(found))


def of_world(asked: Asked, world: str, data_dir: Path) -> Proposal:
    """From rendered pairs, which are kept in `data_dir`."""
    results = measure(
        load_world(world), asked.pipeline, asked.count, asked.seed, data_dir, asked.tick, asked.spans.pair_m
    )
    found = [of_rendering(result, asked.rules) for result in results]
    if asked.rules.sensing.similarity == "verified":
        thresholds = propose(found, asked.spans)
        if asked.spans == INDOOR.spans:
            keypoints, bound_m = asked.pipeline.profile.keypoints, asked.rules.mapping.edge_longest_m
            thresholds["edge_longest_m"] = longest_edge_m(found, asked.spans, keypoints, bound_m)
    else:
        thresholds = propose_by_count(found, asked.spans, asked.pipeline.profile.keypoints)
    return Proposal(found, thresholds, distance_table(results))
