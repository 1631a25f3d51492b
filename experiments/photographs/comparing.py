"""What the planner makes of one picture against others, by the code of feature service and planner. Pure."""

import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from services.features.matching.verification import Candidate, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.planner.mapping.edges import stands_alone
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, ranked, similarity
from shared.messages.matching import NodeMatch

SEED_STRIDE = 1_000_000
"""Pictures are numbered below it: another seed means other draws for all of them."""


@dataclass(frozen=True, eq=False)
class Question:
    """One picture, the frame, against others; all are known by their numbers."""

    query: int
    features: FeatureSet
    candidates: tuple[Candidate, ...]


@dataclass(frozen=True)
class Answer:
    """What is made of one candidate.

    Attributes:
        heading_deg: to the candidate's place, counter-clockwise from the centre column; None: no answer.
        method: which gave it, empty without one.
        edge: whether the planner would connect the two by this match alone.
        ms: to match and verify.
    """

    query: int
    candidate: int
    status: str
    raw_matches: int
    inliers: int
    confidence: float
    heading_deg: float | None
    method: str
    edge: bool
    ms: float


class Answers(NamedTuple):
    """Of one question; `most_similar` is None where no candidate has anything in common with the frame."""

    answers: list[Answer]
    most_similar: int | None


def compare(question: Question, pipeline: Pipeline, profile: Profile, seed: int) -> Answers:
    """The planner's reading of every candidate; the draws depend on the seed and both numbers."""
    matches, answers = {}, []
    for candidate in question.candidates:
        match, ms = verified(question, candidate, pipeline, seed)
        matches[candidate.node_id] = match
        answers.append(_answer(question.query, match, profile, ms))
    order = ranked(matches, profile)
    found = bool(order) and similarity(order[0][1], profile) > 0
    return Answers(answers, order[0][0] if found else None)


def verified(
    question: Question, candidate: Candidate, pipeline: Pipeline, seed: int
) -> tuple[NodeMatch, float]:
    """One match with its pairs of bearings, and the time it took, milliseconds."""
    began_s = time.perf_counter()
    (pairs,) = pipeline.matcher.match(question.features, [candidate.features])
    seq = seed * SEED_STRIDE + question.query
    match = verify(question.features, candidate, pairs, seq, pipeline.verification, True)
    return match, 1000.0 * (time.perf_counter() - began_s)


def _answer(query: int, match: NodeMatch, profile: Profile, ms: float) -> Answer:
    heading = heading_of(match, profile)
    return Answer(
        query=query,
        candidate=match.node_id,
        status=match.status,
        raw_matches=match.raw_matches,
        inliers=match.inliers,
        confidence=match.confidence,
        heading_deg=float(np.degrees(heading[0])) if heading is not None else None,
        method=heading[1] if heading is not None else "",
        edge=stands_alone(match, profile),
        ms=ms,
    )
