"""What a pipeline makes of linked photographs of real places: the figures that decide."""

from collections.abc import Sequence
from typing import Any

from experiments.photographs.eyes import eyes
from experiments.photographs.report import report
from experiments.photographs.study import measure
from experiments.photographs.tours import Tour
from services.planner.profiles import profile_name_for, profile_named

KEPT = ("links", "answered", "within_20", "median_deg", "edges", "wrong_edges", "recall_at_1")


def judge_photographs(name: str, tours: Sequence[Tour], seed: int, jobs: int) -> dict[str, Any]:
    """Links that are answered and right, and edges between places that are different.

    Args:
        name: of the pipeline.
        tours: linked pictures.
        seed: of the pairs of different tours that are compared.
        jobs: processes.
    """
    rules = profile_named(profile_name_for(name, "photo"))
    with eyes(name, rules, seed, jobs, lambda _: None) as looking:
        figures = report(measure(tours, looking, quick=True), name)
    return {key: figures["total"][key] for key in KEPT} | {
        "ms_frame": figures["ms_per_picture"],
        "ms_pair": figures["ms_per_pair"],
    }
