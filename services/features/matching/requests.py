"""One MATCH question, answered in two steps so that each can be timed: match, then verify. Pure."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

from services.features.map_features.map_features import MapFeatures
from services.features.matching.difference import differences
from services.features.matching.photo_verification import verify_photo
from services.features.matching.ranking import answer, considered, is_settled, shortlist
from services.features.matching.verification import Candidate, feature_set, verify
from services.features.pipeline.interfaces import FeatureSet, Matched
from services.features.pipeline.pipeline import Pipeline
from shared.messages.features import Features, PhotoView
from shared.messages.matching import MatchRequest, NodeMatch

BESIDE_RAD = math.radians(6.0)
"""Disparity up to which two pictures are compared as pictures; chosen: some 0.7 m indoors, from where a view
is still much the same."""
ABOUT_RAD = math.radians(12.0)
"""The same for nodes, between which a picture was taken: that of its own room then differs least of all."""


class RequestError(ValueError):
    """A question that cannot be answered as asked; the text says why, `code` for programs."""

    code = ""


class FrameNotKeptError(RequestError):
    """It is about a frame that was dropped, is too old, or has not arrived yet."""

    code = "passing"


class NotReadyError(RequestError):
    """The service has something to do first: the same question will succeed later."""

    code = "busy"


Pictures = Callable[[Sequence[int]], Mapping[int, bytes]]
"""The JPEG of each node asked for, b"" where it has none."""
Detailed = Callable[[Sequence[int]], MapFeatures]
"""Nodes with more keypoints, as far as there are; NotReadyError where that takes a while."""


@dataclass(frozen=True, eq=False)
class RawMatches:
    """Matches by descriptor alone: the candidates by id, their pairs, and who was shortlisted."""

    query: FeatureSet
    seq: int
    thumbnail: bytes
    photo: PhotoView | None
    candidates: Mapping[int, Candidate]
    pairs: Mapping[int, Matched]
    shortlisted: list[int]


def match_candidates(
    pipeline: Pipeline,
    request: MatchRequest,
    current: Features,
    nodes: MapFeatures,
    detailed: Detailed | None = None,
) -> RawMatches:
    """Match the descriptors of the current frame with every candidate.

    In a large map the candidates for `best_k` are the nodes that resemble the frame as a whole. A photo is
    compared with their `detailed` features.

    Raises:
        RequestError: something was made by another pipeline, or a node is not in the map.
        NotReadyError: of a photo whose candidates have to be looked at first.
    """
    _require_pipeline("frame", current, pipeline)
    missing = sorted(node_id for node_id in set(request.node_ids) if node_id not in nodes)
    if missing:
        raise RequestError(f"map {request.map!r} has no node {missing[:8]}")
    _require_comparable(request, nodes, pipeline)
    query = feature_set(current)
    wanted = _wanted(request, query, nodes)
    shown = detailed(wanted) if detailed is not None and current.photo is not None else nodes
    candidates = {n: Candidate(n, (shown if n in shown else nodes).features(n)) for n in wanted}
    for number, target in enumerate(request.targets, start=1):
        _require_pipeline(f"target {number}", target, pipeline)
        candidates[-number] = Candidate(-number, feature_set(target))
    found = pipeline.matcher.match(query, [candidate.features for candidate in candidates.values()])
    pairs = dict(zip(candidates, found, strict=True))
    of_map = {node_id: rows for node_id, rows in pairs.items() if node_id >= 0}
    return RawMatches(
        query,
        current.seq,
        current.thumbnail,
        current.photo,
        candidates,
        pairs,
        shortlist(of_map, request.best_k),
    )


def verify_candidates(
    pipeline: Pipeline,
    request: MatchRequest,
    raw: RawMatches,
    known: dict[int, NodeMatch] | None = None,
) -> tuple[NodeMatch, ...]:
    """Verify the nodes asked for, the targets and as much of the shortlist as matters; most similar first.

    Nodes in `known` are not verified again; the others are added to it.
    """
    of_nodes = {} if known is None else known

    def verified(node_id: int) -> NodeMatch:
        if node_id in of_nodes:
            return of_nodes[node_id]
        candidate, pairs = raw.candidates[node_id], raw.pairs[node_id]
        if raw.photo is not None:
            of_nodes[node_id] = verify_photo(
                raw.query, raw.photo, candidate, pairs, raw.seq, request.with_matches
            )
            return of_nodes[node_id]
        match = verify(raw.query, candidate, pairs, raw.seq, pipeline.verification, request.with_matches)
        if node_id >= 0:
            of_nodes[node_id] = match
        elif _is_within(BESIDE_RAD, match):
            match = _looked_at(match, raw.thumbnail, request.targets[-1 - node_id].thumbnail)
        return match

    asked = sorted({*request.node_ids, *(n for n in raw.candidates if n < 0)})
    results = {node_id: verified(node_id) for node_id in asked}
    best: list[NodeMatch] = []
    for node_id in raw.shortlisted:
        if is_settled(best, request.best_k, len(raw.pairs[node_id])):
            break
        if node_id not in results:
            results[node_id] = verified(node_id)
        best.append(results[node_id])
    return answer(results, asked, best, request.best_k)


def look_at_nodes(
    found: Sequence[NodeMatch], node_ids: Collection[int], thumbnail: bytes, pictures: Pictures
) -> tuple[NodeMatch, ...]:
    """The same with how much some nodes differ from a frame as pictures, where it was taken about there.

    Args:
        found: the frame against nodes.
        node_ids: those to look at.
        thumbnail: of the frame.
        pictures: of nodes.
    """
    near = [m.node_id for m in found if m.node_id in node_ids and _is_within(ABOUT_RAD, m)]
    shown = pictures(near) if near else {}
    return tuple(_looked_at(m, thumbnail, shown[m.node_id]) if m.node_id in shown else m for m in found)


def _is_within(far_rad: float, match: NodeMatch) -> bool:
    return match.yaw_rad is not None and match.disparity_rad is not None and match.disparity_rad <= far_rad


def _looked_at(match: NodeMatch, thumbnail: bytes, picture: bytes) -> NodeMatch:
    """The match of a picture that was taken nearby, with how much the two differ as pictures."""
    differ = differences(thumbnail, picture, match.yaw_rad or 0.0)
    return match.model_copy(update={"differences": differ})


def _wanted(request: MatchRequest, query: FeatureSet, nodes: MapFeatures) -> Sequence[int]:
    if not request.best_k:
        return sorted(set(request.node_ids))
    return sorted({*request.node_ids, *nodes.nearest(query, considered(request.best_k))})


def _require_comparable(request: MatchRequest, nodes: MapFeatures, pipeline: Pipeline) -> None:
    others = nodes.of_other_pipelines
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
