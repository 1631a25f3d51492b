"""A rendered pair is judged by the similarity that the planner sees."""

from dataclasses import replace

import numpy as np

from experiments.rendered.headings import judge_pair
from experiments.rendered.pairs import PosePair
from services.features.pipeline.extraction import extract
from services.features.pipeline.named_pipelines import PROFILES
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from tests.unit.services.features.room import render_room


def test_doubtful_matches_do_not_count_as_similarity(monkeypatch):
    pipeline = Pipeline(PROFILES["sift"])
    here, there = (
        extract(render_room(*place, 400), pipeline.extractor, pipeline.representation, pipeline.profile)
        for place in ((0.0, 0.0, 0.0), (0.5, 0.2, 0.7))
    )
    pair = PosePair(Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0), Pose(x_m=0.5, y_m=0.2, yaw_rad=0.7))
    plain = judge_pair(pair, here, there, pipeline, 1)
    (matched,) = pipeline.matcher.match(here, [there])
    halved = replace(matched, doubtful=np.arange(len(matched)) % 2 == 0)
    monkeypatch.setattr(pipeline.matcher, "match", lambda *_: [halved])
    found = judge_pair(pair, here, there, pipeline, 1)
    assert found.verified_errors_rad == plain.verified_errors_rad
    assert (plain.raw, found.raw) == (len(matched), len(matched) // 2)
    assert 0.3 * plain.verified < found.verified < 0.7 * plain.verified
