"""What was found for a frame counts for that frame, map and revision only."""

import numpy as np

from services.features.map_features.map_cache import CachedMap
from services.features.map_features.map_features import MapFeatures
from services.features.robot_streams import Answered
from shared.messages.features import Features
from shared.messages.matching import NodeMatch

MATCH = NodeMatch(node_id=4, raw_matches=9, inliers=8, status="inconsistent")


def frame(level=0):
    lonlat, scores, descriptors = np.zeros((1, 2), "f4"), np.ones(1, "f4"), np.full((1, 4), level, "u1")
    return Features(seq=7, pipeline="p", lonlat_rad=lonlat, scores=scores, descriptors=descriptors)


def known_map():
    return CachedMap(3, MapFeatures("p", 10, "euclidean"))


def first_question():
    answered, about, nodes = Answered(), frame(), known_map()
    answered.of(about, nodes, with_matches=True)[4] = MATCH
    return answered, about, nodes


def test_a_second_question_about_the_frame_finds_what_the_first_one_added():
    answered, about, nodes = first_question()
    assert answered.of(about, nodes, with_matches=True) == {4: MATCH}


def test_a_map_that_changed_begins_anew():
    answered, about, nodes = first_question()
    nodes.revision += 1
    assert answered.of(about, nodes, with_matches=True) == {}


def test_another_map_of_the_same_revision_begins_anew():
    answered, about, _ = first_question()
    assert answered.of(about, known_map(), with_matches=True) == {}


def test_another_frame_of_the_same_number_begins_anew():
    answered, _, nodes = first_question()
    assert answered.of(frame(level=1), nodes, with_matches=True) == {}


def test_the_same_frame_sent_with_another_question_finds_them_too():
    answered, _, nodes = first_question()
    assert answered.of(frame(), nodes, with_matches=True) == {4: MATCH}


def test_a_question_without_matches_begins_anew():
    answered, about, nodes = first_question()
    assert answered.of(about, nodes, with_matches=False) == {}
