"""One run over tours: links, look-alikes, foreign pairs, tilted pictures, and the figures of all of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from experiments.photographs.comparing import Answer, Question
from experiments.photographs.eyes import Eyes
from experiments.photographs.looks import Look, Seen
from experiments.photographs.tables import LinkAnswer
from experiments.photographs.tilted import Few, tilt_rows
from experiments.photographs.tours import Tour, foreign_pairs
from services.features.matching.verification import Candidate

FOREIGN_MOST, FOREIGN_QUICK = 2000, 200
"""Pairs of different tours compared; chosen: a share of 0.1 % shows, in about a minute of one core."""

FEW, FEW_QUICK = Few(pictures=20, links=40), Few(pictures=4, links=6)


@dataclass(frozen=True)
class TourFound:
    """What was found in a tour; pictures are numbered over all tours.

    Attributes:
        first: number of its first picture.
        links: answers in the order of the file.
        wrong: one answer for each pair of look-alikes that would become an edge.
        recalled: of each picture with a link, whether the most similar one is a neighbour.
    """

    tour: Tour
    first: int
    links: list[LinkAnswer]
    wrong: list[Answer]
    recalled: list[bool]


@dataclass(frozen=True)
class Found:
    """What was found in all tours.

    Attributes:
        seen: all pictures, by number.
        foreign: pairs of different tours that were compared.
        foreign_wrong: an answer for each of those that would become an edge.
        ms: of every comparison within a tour.
    """

    tours: list[TourFound]
    seen: list[Seen]
    foreign: list[tuple[int, int]]
    foreign_wrong: list[Answer]
    tilt: list[dict[str, Any]]
    ms: list[float]

    @property
    def links(self) -> list[LinkAnswer]:
        """The links of all tours."""
        return [link for tour in self.tours for link in tour.links]

    def question(self, query: int, candidates: Sequence[int]) -> Question:
        """One picture against others."""
        others = tuple(Candidate(number, self.seen[number].features) for number in candidates)
        return Question(query, self.seen[query].features, others)


def paths_of(tours: Sequence[Tour]) -> list[Look]:
    """The pictures of all tours, as they are numbered."""
    return [Look(path) for tour in tours for path in tour.paths]


def measure(tours: Sequence[Tour], eyes: Eyes, *, quick: bool) -> Found:
    """Look at every picture once, compare all pictures of each tour, then those of different tours."""
    rng = np.random.default_rng(eyes.way.seed)
    seen = eyes.look(paths_of(tours), "pictures")
    found = Found([], seen, [], [], [], [])
    first = 0
    for tour in tours:
        found.tours.append(_of_tour(tour, first, found, eyes))
        first += len(tour.paths)
    tour_of = [k for k, tour in enumerate(tours) for _ in tour.paths]
    found.foreign.extend(foreign_pairs(tour_of, FOREIGN_QUICK if quick else FOREIGN_MOST, rng))
    found.foreign_wrong.extend(_edges(_either_way(found, found.foreign, eyes), found.foreign))
    few = FEW_QUICK if quick else FEW
    found.tilt.extend(tilt_rows(paths_of(tours), seen, found.links, few, rng, eyes))
    return found


def _of_tour(tour: Tour, first: int, found: Found, eyes: Eyes) -> TourFound:
    """Every picture against every other one of its tour: links, look-alikes and ranks come of it."""
    numbers = range(first, first + len(tour.paths))
    questions = [found.question(a, [b for b in numbers if b != a]) for a in numbers]
    compared = eyes.compare(questions, tour.file.name)
    answers = {(one.query, one.candidate): one for each in compared for one in each.answers}
    found.ms.extend(one.ms for one in answers.values())
    links = [LinkAnswer(deg, answers[first + a, first + b]) for a, b, deg in tour.links()]
    recalled = [
        nearest is not None and nearest - first in neighbours
        for a, neighbours in sorted(tour.neighbours().items())
        for nearest in [compared[a].most_similar]
    ]
    alike = [(first + a, first + b) for a, b in tour.look_alikes()]
    return TourFound(tour, first, links, _edges(answers, alike), recalled)


def _either_way(found: Found, pairs: Sequence[tuple[int, int]], eyes: Eyes) -> dict[tuple[int, int], Answer]:
    """Answers to pairs, each with either picture as the frame."""
    others: dict[int, list[int]] = {}
    for a, b in pairs:
        others.setdefault(a, []).append(b)
        others.setdefault(b, []).append(a)
    questions = [found.question(a, of) for a, of in sorted(others.items())]
    compared = eyes.compare(questions, "pictures of different tours")
    return {(one.query, one.candidate): one for each in compared for one in each.answers}


def _edges(answers: dict[tuple[int, int], Answer], pairs: Sequence[tuple[int, int]]) -> list[Answer]:
    """An answer for each pair that becomes an edge, whichever picture is the frame."""
    both = ([answers[a, b], answers[b, a]] for a, b in pairs)
    edges = ([one for one in each if one.edge] for each in both)
    return [each[0] for each in edges if each]
