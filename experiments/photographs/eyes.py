"""A pipeline and a planner's profile at work on many pictures, in this process or in several."""

import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, partial
from typing import TypeVar

import cv2

from experiments.photographs.comparing import Answers, Question, compare
from experiments.photographs.looks import Look, Seen, seen
from experiments.work.workers import workers
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.profiles import Profile

Tick = Callable[[str], None]
Asked = TypeVar("Asked")
Got = TypeVar("Got")


@dataclass(frozen=True)
class Way:
    """How pictures are read: everything that decides an answer but the pictures.

    Attributes:
        alone: one process does all the work and may use all cores.
    """

    pipeline: str
    profile: Profile
    seed: int
    alone: bool


class Eyes:
    """Looks and compares; what takes long is told to `tick`."""

    def __init__(self, way: Way, pool: Executor | None, tick: Tick) -> None:
        """Use the processes of a pool, or this one."""
        self.way, self._pool, self._tick = way, pool, tick

    @property
    def pipeline(self) -> Pipeline:
        """The pipeline in this process."""
        return _pipeline(self.way.pipeline, self.way.alone)

    def look(self, looks: Sequence[Look], what: str) -> list[Seen]:
        """Features of pictures, in their order."""
        return list(self._each(partial(_look, self.way), looks, what))

    def compare(self, questions: Sequence[Question], what: str) -> list[Answers]:
        """Answers to questions, in their order."""
        return list(self._each(partial(_compare, self.way), questions, what))

    def _each(self, function: Callable[[Asked], Got], items: Sequence[Asked], what: str) -> Iterator[Got]:
        results = map(function, items) if self._pool is None else self._pool.map(function, items)
        for number, result in enumerate(results, start=1):
            self._tick(f"{what}: {number} of {len(items)}")
            yield result


@contextmanager
def eyes(pipeline: str, profile: Profile, seed: int, jobs: int, tick: Tick) -> Iterator[Eyes]:
    """Eyes for the time of a study.

    Args:
        pipeline: its name.
        profile: of the planner.
        seed: of the draws of verification.
        jobs: processes; 1 works in this one.
        tick: hears how far the work is.

    Raises:
        ValueError: no such pipeline.
    """
    find_profile(pipeline)
    way = Way(pipeline, profile, seed, alone=jobs == 1)
    if jobs == 1:
        yield Eyes(way, None, tick)
        return
    with workers(jobs, None) as pool:
        yield Eyes(way, pool, tick)


def _look(way: Way, look: Look) -> Seen:
    return seen(look, _pipeline(way.pipeline, way.alone))


def _compare(way: Way, question: Question) -> Answers:
    return compare(question, _pipeline(way.pipeline, way.alone), way.profile, way.seed)


@cache
def _pipeline(name: str, alone: bool) -> Pipeline:
    pipeline = Pipeline(find_profile(name))
    if not alone:
        # Side by side, more threads only get in each other's way.
        cv2.setNumThreads(1)
        if "torch" in sys.modules:
            sys.modules["torch"].set_num_threads(1)
    return pipeline
