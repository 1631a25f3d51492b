"""How fast services grow: a straight line through their memory over time, by least squares. Pure."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

WARM_UP_S = 120.0
"""A young process fills its caches: that is no leak."""


@dataclass(frozen=True)
class Sample:
    """Resident memory of one process."""

    service: str
    pid: int
    at_s: float
    mb: float


@dataclass(frozen=True)
class Growth:
    """Of one service, over all processes it was.

    Attributes:
        mb_per_h: slope common to its processes, each with a level of its own; None if too little is known.
        observed_s: time that the slope rests on.
    """

    mb_per_h: float | None
    observed_s: float
    largest_mb: float


def growth(samples: Iterable[Sample]) -> dict[str, Growth]:
    """Fit each service."""
    by_process: defaultdict[str, defaultdict[int, list[Sample]]] = defaultdict(lambda: defaultdict(list))
    for sample in samples:
        by_process[sample.service][sample.pid].append(sample)
    return {service: _fit(processes) for service, processes in by_process.items()}


def _fit(processes: Mapping[int, list[Sample]]) -> Growth:
    largest_mb = max(sample.mb for process in processes.values() for sample in process)
    products = squares = observed_s = 0.0
    for process in processes.values():
        born_s = min(sample.at_s for sample in process)
        old = [sample for sample in process if sample.at_s - born_s >= WARM_UP_S]
        if len(old) < 2:
            continue
        at_s, mb = np.array([s.at_s for s in old]), np.array([s.mb for s in old])
        at_s = at_s - at_s.mean()
        products += float(at_s @ (mb - mb.mean()))
        squares += float(at_s @ at_s)
        observed_s += float(np.ptp(at_s))
    slope = products / squares * 3600.0 if squares > 0.0 else None
    return Growth(None if slope is None else round(slope, 2), round(observed_s, 1), round(largest_mb, 1))
