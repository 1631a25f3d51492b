"""Pictures against themselves, and links, as if a camera had been tilted by some degrees."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from experiments.photographs.comparing import Question
from experiments.photographs.eyes import Eyes
from experiments.photographs.looks import Look, Seen
from experiments.photographs.tables import LinkAnswer, apart_deg, tilt_row
from experiments.photographs.tilting import pitch_roll
from services.features.matching.verification import Candidate

TILTS_DEG = (1.0, 2.0, 5.0, 10.0)
"""Chosen: a tripod, a hand-held stick, a kerb, a slope."""


One = TypeVar("One")


@dataclass(frozen=True)
class Few:
    """How many are tilted: re-rendering and extracting a picture takes a third of a second."""

    pictures: int
    links: int


@dataclass(frozen=True)
class Case:
    """One picture to tilt, and which one is the frame that it is compared with, by number."""

    frame: int
    tilted: int
    axis_rad: float


def tilt_rows(
    looks: Sequence[Look],
    seen: Sequence[Seen],
    links: Sequence[LinkAnswer],
    few: Few,
    rng: np.random.Generator,
    eyes: Eyes,
) -> list[dict[str, Any]]:
    """A row for each tilt; all tilts have the same pictures, links and axes.

    Args:
        looks: all pictures.
        seen: their features.
        links: with their answers by upright pictures; those with a heading are drawn from.
        few: how many are tilted.
        rng: draws them and the axes.
        eyes: look and compare.
    """
    answered = [link.answer for link in links if link.answer.heading_deg is not None]
    pictures, chosen = some(range(len(looks)), few.pictures, rng), some(answered, few.links, rng)
    pairs = [(n, n) for n in pictures] + [(one.query, one.candidate) for one in chosen]
    cases = [
        Case(*pair, axis)
        for pair, axis in zip(pairs, rng.uniform(-math.pi, math.pi, len(pairs)).tolist(), strict=True)
    ]
    rows = []
    for deg in TILTS_DEG:
        tilted = eyes.look(
            [_tilted(looks[one.tilted], deg, one.axis_rad) for one in cases], f"tilt {deg:g} deg"
        )
        questions = [
            Question(one.frame, seen[one.frame].features, (Candidate(one.tilted, new.features),))
            for one, new in zip(cases, tilted, strict=True)
        ]
        answers = [each.answers[0] for each in eyes.compare(questions, f"tilt {deg:g} deg")]
        changes = [
            apart_deg(after.heading_deg, before.heading_deg)
            for before, after in zip(chosen, answers[len(pictures) :], strict=True)
            if after.heading_deg is not None and before.heading_deg is not None
        ]
        rows.append(tilt_row(deg, answers[: len(pictures)], changes))
    return rows


def some(items: Sequence[One], most: int, rng: np.random.Generator) -> list[One]:
    """All items, or `most` of them, in their order."""
    if len(items) <= most:
        return list(items)
    return [items[int(k)] for k in np.sort(rng.choice(len(items), most, replace=False))]


def _tilted(look: Look, deg: float, axis_rad: float) -> Look:
    pitch_rad, roll_rad = pitch_roll(math.radians(deg), axis_rad)
    return replace(look, pitch_rad=pitch_rad, roll_rad=roll_rad)
