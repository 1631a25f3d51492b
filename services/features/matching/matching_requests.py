"""One MATCH question, answered in two steps so that each can be timed: pair, then verify. Pure."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from services.features.matching.comparison import answer, considered, is_settled, shortlist
from services.features.matching.verification import Candidate, feature_set, verify
from services.features.pipeline.interfaces import FeatureSet, IndexArray
from services.features.pipeline.pipeline import Pipeline
from services.features.places.places import Places
from shared.messages.features import Features
from shared.messages.matching import MatchRequest, NodeMatch


class RequestError(ValueError):
    """A question that cannot be answered as asked; the text says why, `code` for programs."""

    code = ""


class FrameNotKeptError(RequestError):
    """It is about a frame that was dropped, is too old, or has not arrived yet."""

    code = "passing"


@dataclass(frozen=True, eq=False)
class Paired:
    """Raw matches of a question: the candidates by id, their pairs, and who was shortlisted."""

    query: FeatureSet
    seq: int
    candidates: Mapping[int, Candidate]
    pairs: Mapping[int, IndexArray]
    shortlisted: list[int]


def pair(pipeline: Pipeline, request: MatchRequest, current: Features, places: Places) -> Paired:
    """Match the descriptors of the current frame with every candidate.

    In a large map the candidates for `best_k` are the places that resemble the frame as a whole.

    Raises:
        RequestError: something was made by another pipeline, or a node is not in the map.
    """
    _require_pipeline("frame", current, pipeline)
    missing = sorted(node_id for node_id in set(request.node_ids) if node_id not in places)
    if missing:
        raise RequestError(f"map {request.map!r} has no node {missing[:8]}")
    _require_comparable(request, places, pipeline)
    query = feature_set(current)
    wanted = _wanted(request, query, places)
    candidates = {node_id: Candidate(node_id, places.words(node_id)) for node_id in wanted}
    for number, target in enumerate(request.targets, start=1):
        _require_pipeline(f"target {number}", target, pipeline)
        candidates[-number] = Candidate(-number, feature_set(target))
    found = pipeline.matcher.match(query, [candidate.features for candidate in candidates.values()])
    pairs = dict(zip(candidates, found, strict=True))
    of_map = {node_id: rows for node_id, rows in pairs.items() if node_id >= 0}
    return Paired(query, current.seq, candidates, pairs, shortlist(of_map, request.best_k))


def verify_paired(pipeline: Pipeline, request: MatchRequest, paired: Paired) -> tuple[NodeMatch, ...]:
    """Verify the nodes asked for, the targets and as much of the shortlist as matters; most similar first."""
    asked = sorted({*request.node_ids, *(n for n in paired.candidates if n < 0)})
    results = {node_id: _verify_one(pipeline, request, paired, node_id) for node_id in asked}
    best: list[NodeMatch] = []
    for node_id in paired.shortlisted:
        if is_settled(best, request.best_k, len(paired.pairs[node_id])):
            break
        if node_id not in results:
            results[node_id] = _verify_one(pipeline, request, paired, node_id)
        best.append(results[node_id])
    return answer(results, asked, best, request.best_k)


def _verify_one(pipeline: Pipeline, request: MatchRequest, paired: Paired, node_id: int) -> NodeMatch:
    return verify(
        paired.query,
        paired.candidates[node_id],
        paired.pairs[node_id],
        paired.seq,
        pipeline.verification,
        request.with_matches,
    )


def _wanted(request: MatchRequest, query: FeatureSet, places: Places) -> Sequence[int]:
    if not request.best_k:
        return sorted(set(request.node_ids))
    return sorted({*request.node_ids, *places.nearest(query, considered(request.best_k))})


def _require_comparable(request: MatchRequest, places: Places, pipeline: Pipeline) -> None:
    others = places.others
    for node_id in sorted(others) if request.best_k else sorted(others.keys() & set(request.node_ids)):
        raise RequestError(_mismatch(f"node {node_id}", others[node_id], pipeline))


def _require_pipeline(what: str, features: Features, pipeline: Pipeline) -> None:
    if features.pipeline != pipeline.identity:
        raise RequestError(_mismatch(what, features.pipeline, pipeline))


def _mismatch(what: str, made_by: str, pipeline: Pipeline) -> str:
    return (
        f"{what} was made by pipeline {made_by!r}, this service runs {pipeline.identity!r}: "
        "extract it again or start the service with that pipeline"
    )
