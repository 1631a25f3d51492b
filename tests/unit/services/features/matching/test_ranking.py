"""Who is verified and who is reported, in which order."""

import numpy as np

from services.features.matching.ranking import answer, is_settled, shortlist
from shared.messages.matching import NodeMatch


def pairs(count: int) -> np.ndarray:
    return np.zeros((count, 2), np.intp)


def match(node_id: int, inliers: int, raw_matches: int = 50) -> NodeMatch:
    return NodeMatch(node_id=node_id, raw_matches=raw_matches, inliers=inliers, status="ok")


def test_twice_as_many_as_asked_for_are_verified_most_raw_matches_first():
    found = {1: pairs(5), 2: pairs(9), 3: pairs(9), 4: pairs(1), 5: pairs(7)}
    assert shortlist(found, 2) == [2, 3, 5, 1]
    assert shortlist(found, 0) == []
    assert shortlist({}, 4) == []


def test_the_best_by_inliers_are_reported_with_all_asked_for():
    results = {n: match(n, inliers) for n, inliers in ((1, 10), (2, 40), (3, 30), (4, 2), (-1, 35))}
    told = answer(results, asked=[-1, 4], best=[results[n] for n in (1, 2, 3)], best_k=1)
    assert [result.node_id for result in told] == [2, -1, 4]


def test_ties_are_settled_by_raw_matches_then_by_id():
    results = {1: match(1, 10, 20), 2: match(2, 10, 30), 3: match(3, 10, 30)}
    assert [r.node_id for r in answer(results, [1, 2, 3], [], 0)] == [2, 3, 1]


def test_no_more_is_verified_than_can_matter():
    best = [match(1, 40), match(2, 30), match(3, 5)]
    assert is_settled(best, 2, raw_matches=30)
    assert not is_settled(best, 2, raw_matches=31)
    assert not is_settled(best, 4, raw_matches=1)
    assert is_settled([], 0, raw_matches=99)
