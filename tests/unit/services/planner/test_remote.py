"""The planner's view of the feature service counts what the answers for one frame cost."""

import pytest

from services.planner.remote import RemoteMap, RemoteMatcher
from shared.messages import MatchReply


class Answers:
    """A bus on which every question about matches costs the same."""

    def ask(self, _query, _request, _timeout_s, **_names):
        return MatchReply(map="flat", match_ms=2.0, verify_ms=7.5)


@pytest.fixture
def matcher():
    bus = Answers()
    return RemoteMatcher(bus, "r1", RemoteMap(bus, "flat", 1.0), 1.0)


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
