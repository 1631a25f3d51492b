"""Thresholds from tours of photographs."""

import pytest

from experiments.calibration.thresholds import propose
from experiments.calibration.tours import pairs_of_tours
from experiments.photographs.tours import read_tour, read_tours
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.environments import Spans
from services.launcher.client.failure import ExperimentError
from services.planner.profiles import PHOTO


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline(find_profile("photo"))


def measured(tours, pipeline):
    return pairs_of_tours(tours, pipeline, PHOTO, 1, lambda _: None)


def test_links_of_a_rendered_tour_give_thresholds(example, pipeline):
    tours = read_tours(example)
    pairs, _ = measured(tours, pipeline)
    assert len(pairs) == sum(len(tour.links()) for tour in tours)
    assert any(pair.similarity > 100 and not pair.is_wrong for pair in pairs)
    assert set(propose(pairs, Spans(), doubtful=True)) == {"s_via_min", "s_edge_min"}


def test_a_tour_without_links_is_refused(write_tour, pipeline):
    with pytest.raises(ExperimentError, match="expected links"):
        measured([read_tour(write_tour(links=[], rooms={}))], pipeline)
