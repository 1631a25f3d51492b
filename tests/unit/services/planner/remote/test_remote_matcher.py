"""The planner's view of the feature service: what answers cost, and only places that it knows itself."""

import pytest

from services.planner.remote.remote_map import RemoteMap
from services.planner.remote.remote_matcher import PHOTO_S, RemoteMatcher
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import GOAL
from shared.messages.features import PhotoView
from shared.messages.maps import Node
from shared.messages.matching import MatchReply, NodeMatch
from tests.plane_world import picture


class Answers:
    """A bus on which every question about matches has the same answer."""

    def __init__(self):
        self.asked = []
        self.waited_s = 0.0

    def ask(self, _query, request, timeout_s, **_names):
        self.asked.append(request)
        self.waited_s = timeout_s
        results = tuple(NodeMatch(node_id=n, raw_matches=9, inliers=9, status="ok") for n in (GOAL, 1, 2))
        return MatchReply(map="flat", match_ms=2.0, verify_ms=7.5, results=results)


@pytest.fixture
def matcher():
    bus = Answers()
    maps = RemoteMap(bus, "flat", 1.0)
    maps.graph = MapGraph([Node(node_id=1)])
    return RemoteMatcher(bus, "r1", maps, 1.0)


def test_costs_of_all_questions_about_one_frame_add_up(matcher):
    matcher.begin(5, 50)
    matcher.match((1, 2))
    matcher.match((), best_k=3)
    assert (matcher.match_ms, matcher.verify_ms) == (4.0, 15.0)


def test_costs_start_at_zero_with_each_frame(matcher):
    matcher.begin(5, 50)
    matcher.match((1,))
    matcher.begin(6, 60)
    assert (matcher.match_ms, matcher.verify_ms) == (0.0, 0.0)


def test_a_place_of_another_robot_that_the_planner_has_not_heard_of_yet_is_left_out(matcher):
    assert matcher.match((), best_k=3).keys() == {GOAL, 1}


@pytest.mark.parametrize("photo", [None, PhotoView(fov_rad=1.2, fov_known=True, aspect=0.75)])
def test_only_of_a_photo_the_matches_themselves_are_asked_for_and_waited_for_longer(photo):
    bus = Answers()
    matcher = RemoteMatcher(bus, "r1", RemoteMap(bus, "flat", 1.0), 1.0)
    matcher.locate(picture((0.0, 0.0, 0.0)).model_copy(update={"photo": photo}), 60)
    (asked,) = bus.asked
    assert (asked.best_k, asked.with_matches) == (60, photo is not None)
    assert bus.waited_s == (1.0 if photo is None else PHOTO_S)
