"""A question about a goal picture: beside where it was taken it is compared as a picture as well."""

import numpy as np
import pytest

from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import look_at_nodes, match_candidates, verify_candidates
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.messages.matching import MatchRequest
from shared.messages.sensors import Frame
from tests.unit.services.features.matching.blobs import blobs

WIDTH_PX, HEIGHT_PX = 1024, 512


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline(find_profile("sift"))


def panorama(seed):
    return blobs(WIDTH_PX, 32, seed)


def features_of(pipeline, picture):
    data = picture.tobytes()
    return pipeline.features_of(
        Frame(robot="r1", encoding="bgr8", width_px=WIDTH_PX, height_px=HEIGHT_PX, data=data)
    )


def answer(pipeline, picture, target):
    """The match of a frame with a goal picture."""
    frame, goal = features_of(pipeline, picture), features_of(pipeline, target)
    request = MatchRequest(map="flat", targets=(goal,))
    raw = match_candidates(pipeline, request, frame, MapFeatures.of(pipeline))
    (match,) = verify_candidates(pipeline, request, raw)
    return match


def test_a_picture_of_the_same_spot_hardly_differs(pipeline):
    picture = panorama(1)
    match = answer(pipeline, np.roll(picture, -256, axis=1), picture)
    assert match.status == "no_baseline"
    assert match.differences.max() < 10.0


def test_what_was_changed_there_shows(pipeline):
    picture, changed = panorama(1), panorama(1)
    changed[300:420, 400:560] = changed[300:420, 400:560, ::-1]
    assert answer(pipeline, picture, changed).differences.max() > 20.0


def test_a_picture_of_another_place_is_not_compared(pipeline):
    match = answer(pipeline, panorama(1), panorama(2))
    assert match.yaw_rad is None
    assert match.differences is None


def test_of_nodes_asked_for_the_pictures_of_those_near_by_are_looked_at(pipeline):
    """Nodes 0 and 1 show the place, 1 changed and 2 without a picture; 3 shows another place."""
    changed = panorama(1)
    changed[300:420, 400:560] = changed[300:420, 400:560, ::-1]
    views = [features_of(pipeline, each) for each in (panorama(1), changed, panorama(1), panorama(2))]
    pictures = dict(enumerate((views[0].thumbnail, views[1].thumbnail, b"", views[3].thumbnail)))
    nodes, asked = MapFeatures.of(pipeline), []
    for node_id, view in enumerate(views):
        nodes.put(node_id, view)
    request = MatchRequest(map="flat", node_ids=(0, 1, 2, 3))
    raw = match_candidates(pipeline, request, views[0], nodes)

    def shown(node_ids):
        asked.extend(node_ids)
        return {node_id: pictures[node_id] for node_id in node_ids}

    results = verify_candidates(pipeline, request, raw)
    found = {m.node_id: m.differences for m in look_at_nodes(results, {1, 2, 3}, views[0].thumbnail, shown)}
    assert sorted(asked) == [1, 2]
    assert [node_id for node_id, differ in found.items() if differ is not None] == [1]
    assert found[1].max() > 20.0
