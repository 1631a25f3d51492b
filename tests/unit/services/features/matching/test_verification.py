"""Verified matches tell the direction of another node, the same every time."""

from dataclasses import replace

import numpy as np
import pytest

from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import RequestError, match_candidates, verify_candidates
from services.features.matching.verification import Candidate, verify
from services.features.pipeline.extraction import extract
from services.features.pipeline.named_pipelines import PROFILES
from services.features.pipeline.pipeline import Pipeline
from shared.messages.features import Features
from shared.messages.matching import MatchRequest

STEP_M = (0.5, 0.2)
YAW_RAD = 0.7


@pytest.fixture(scope="module", params=["sift", "orb", "beblid"])
def pipeline(request) -> Pipeline:
    return Pipeline(PROFILES[request.param])


def features(pipeline: Pipeline, picture: np.ndarray) -> Features:
    found = extract(picture, pipeline.extractor, pipeline.representation, pipeline.profile)
    return Features(
        seq=3,
        pipeline=pipeline.identity,
        lonlat_rad=found.lonlat_rad,
        scores=found.scores,
        descriptors=found.descriptors,
    )


def nodes(pipeline: Pipeline, **of: Features) -> MapFeatures:
    kept = MapFeatures.of(pipeline)
    for name, found in of.items():
        kept.put(int(name.removeprefix("n")), found)
    return kept


def test_heading_and_yaw_of_another_place(room, pipeline):
    here = features(pipeline, room(0.0, 0.0, 0.0, 400))
    there = nodes(pipeline, n8=features(pipeline, room(*STEP_M, YAW_RAD, 400)))
    request = MatchRequest(map="flat", node_ids=(8,))
    answers = [
        verify_candidates(pipeline, request, match_candidates(pipeline, request, here, there))[0]
        for _ in range(2)
    ]
    found = answers[0]
    assert found.status == "ok"
    assert found.inliers > 0.8 * found.raw_matches > 60
    assert found.heading_rad == pytest.approx(np.arctan2(STEP_M[1], STEP_M[0]), abs=np.deg2rad(2.0))
    assert found.yaw_rad == pytest.approx(YAW_RAD, abs=np.deg2rad(0.5))
    assert found.matches_rad.shape == (found.raw_matches, 4)
    assert found.model_dump() == answers[1].model_dump()


def test_doubtful_matches_help_to_find_the_motion_and_do_not_count(room, pipeline):
    here, there = (
        extract(room(*place, 400), pipeline.extractor, pipeline.representation, pipeline.profile)
        for place in ((0.0, 0.0, 0.0), (*STEP_M, YAW_RAD))
    )
    (matched,) = pipeline.matcher.match(here, [there])
    plain, halved = (
        verify(here, Candidate(8, there), replace(matched, doubtful=doubtful), 3, pipeline.verification, True)
        for doubtful in (None, np.arange(len(matched)) % 2 == 0)
    )
    assert (halved.heading_rad, halved.yaw_rad) == (plain.heading_rad, plain.yaw_rad)
    assert len(halved.matches_rad) == len(matched) == plain.raw_matches
    assert halved.raw_matches == len(matched) // 2
    assert halved.inliers == np.count_nonzero(plain.inlier_mask[1::2]) > 0.3 * plain.inliers


def test_a_node_that_was_verified_for_this_frame_is_not_verified_again(room, pipeline):
    here = features(pipeline, room(0.0, 0.0, 0.0, 400))
    there = features(pipeline, room(*STEP_M, YAW_RAD, 400))
    kept, known = nodes(pipeline, n8=there, n9=there), {}
    first, second = (MatchRequest(map="flat", node_ids=(8,)), MatchRequest(map="flat", best_k=2))
    (match,) = verify_candidates(pipeline, first, match_candidates(pipeline, first, here, kept), known)
    found = verify_candidates(pipeline, second, match_candidates(pipeline, second, here, kept), known)
    assert {m.node_id for m in found} == known.keys() == {8, 9}
    assert next(m for m in found if m.node_id == 8) is match


def test_a_node_of_another_pipeline_is_refused_naming_both(pipeline, room):
    here = features(pipeline, room(0.0, 0.0, 0.0, 400))
    other = nodes(pipeline, n8=here.model_copy(update={"pipeline": "superpoint-tangent-150"}))
    with pytest.raises(RequestError, match=f"node 8 .*'superpoint-tangent-150'.*{pipeline.identity!r}"):
        match_candidates(pipeline, MatchRequest(map="flat", best_k=1), here, other)


def test_an_empty_map_has_no_results(pipeline, room):
    here = features(pipeline, room(0.0, 0.0, 0.0, 400))
    request = MatchRequest(map="flat", best_k=5)
    assert (
        verify_candidates(pipeline, request, match_candidates(pipeline, request, here, nodes(pipeline))) == ()
    )
