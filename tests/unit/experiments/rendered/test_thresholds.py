"""Thresholds proposed from hand-made pairs."""

import math

import pytest

from experiments.rendered.headings import METHODS, PairResult
from experiments.rendered.thresholds import propose
from services.launcher.client.environments import Spans


def pair(distance_m, verified, error_deg=0.5):
    errors = dict.fromkeys(METHODS, math.radians(error_deg))
    return PairResult(distance_m, 100, verified, "ok", 0.9, 0.1, 0.0, errors, errors)


NODES = [pair(0.4, 120), pair(0.6, 80), pair(0.7, 90), pair(0.8, 100)]


def test_the_worst_wrong_bearing_sets_the_floor_and_the_safety_factor_follows():
    pairs = [*NODES, pair(2.5, 24, error_deg=35.0), pair(2.5, 60, error_deg=19.0)]
    proposal = propose(pairs, Spans())
    rate = proposal.pop("disparity_rad_per_m")
    assert proposal == {"s_via_min": 24, "s_edge_min": 32, "s_node_max": 90, "s_via_max": 120}
    assert rate == pytest.approx(0.1 / 0.7, rel=0.02) or rate == 0.0


def test_outdoors_nodes_are_further_apart():
    pairs = [pair(1.0, 140), pair(3.0, 50), pair(4.0, 40), pair(0.7, 300)]
    proposal = propose(pairs, Spans(pair_m=(0.5, 12.0), node_m=(2.5, 4.5), near_m=2.0))
    assert (proposal["s_node_max"], proposal["s_via_max"]) == (45, 220)


def test_without_wrong_bearings_a_least_number_of_matches_is_asked_for():
    assert propose(NODES, Spans())["s_via_min"] == 15


def test_too_few_pairs_are_named():
    with pytest.raises(ValueError, match="measure more pairs"):
        propose([pair(2.0, 30)], Spans())
