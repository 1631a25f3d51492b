"""What a picture claims of a node, and whether it is about what is near."""

import math

import pytest

from shared.mapgraph.local.claims import claim_of
from shared.messages.matching import NodeMatch
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(12, 2)


def match(disparity_deg, inliers=60, **other):
    facts = {"status": "ok", "heading_rad": 0.1, "heading_std_rad": 0.01, "yaw_rad": 0.0, "confidence": 0.9}
    seen = None if disparity_deg is None else math.radians(disparity_deg)
    return NodeMatch(node_id=1, raw_matches=inliers, inliers=inliers, disparity_rad=seen, **(facts | other))


@pytest.mark.parametrize(("disparity_deg", "near"), [(14.0, True), (5.0, True), (2.5, False)])
def test_what_moves_as_little_as_clouds_on_so_long_a_way_is_not_near(disparity_deg, near):
    claim = claim_of(GRAPH, 1, match(disparity_deg))
    assert claim.length_m == pytest.approx(
        1.47, abs=0.01
    )  # 60 of 270 matches, half of which are lost in 0.42 m
    assert claim.is_near is near


def test_a_node_that_shares_most_of_the_matches_is_near_whatever_moves():
    assert claim_of(GRAPH, 1, match(0.3, 200)).is_near


def test_what_seems_to_be_the_very_spot_is_far_away_where_few_matches_agree():
    spot = {"status": "no_baseline", "heading_rad": None, "heading_std_rad": None, "confidence": 0.0}
    assert not claim_of(GRAPH, 1, match(0.3, 40, **spot)).is_near
    assert claim_of(GRAPH, 1, match(0.3, 200, **spot)).is_near


def test_what_two_view_geometry_is_not_sure_of_claims_nothing():
    assert claim_of(GRAPH, 1, match(14.0, confidence=0.4)) is None
    assert claim_of(GRAPH, 1, match(14.0, yaw_rad=None)) is None
