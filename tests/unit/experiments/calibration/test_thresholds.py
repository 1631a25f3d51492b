"""Thresholds proposed from hand-made pairs."""

import math
from dataclasses import replace

import pytest

from experiments.calibration.thresholds import Pair, longest_edge_m, propose, propose_by_count
from services.launcher.client.environments import Spans
from services.launcher.client.failure import ExperimentError


def pair(distance_m, verified, error_deg=0.5):
    return Pair(verified, math.radians(error_deg), distance_m)


NODES = [pair(0.4, 120), pair(0.6, 80), pair(0.7, 90), pair(0.8, 100)]


def test_the_worst_wrong_bearing_sets_the_floor_and_the_safety_factor_follows():
    pairs = [*NODES, pair(2.5, 24, error_deg=35.0), pair(2.5, 60, error_deg=19.0)]
    assert propose(pairs, Spans()) == {"s_via_min": 24, "s_edge_min": 32, "s_node_max": 90, "s_via_max": 120}


def test_outdoors_nodes_are_further_apart():
    pairs = [pair(1.0, 140), pair(3.0, 50), pair(4.0, 40), pair(0.7, 300)]
    proposal = propose(pairs, Spans(pair_m=(0.5, 12.0), node_m=(2.5, 4.5), near_m=2.0))
    assert (proposal["s_node_max"], proposal["s_via_max"]) == (45, 220)


def test_without_wrong_bearings_a_least_number_of_matches_is_asked_for():
    assert propose(NODES, Spans())["s_via_min"] == 15


def test_without_distances_nothing_is_said_of_nodes_and_look_alikes_are_below_an_edge():
    linked = [pair(None, 150), pair(None, 90), pair(None, 70)]
    assert propose(linked, Spans()) == {"s_via_min": 15, "s_edge_min": 20}
    assert propose(linked, Spans(), look_alikes=[40, 31]) == {"s_via_min": 15, "s_edge_min": 41}


def test_one_doubtful_bearing_of_twenty_is_no_reason():
    linked = [pair(None, 30 + n) for n in range(19)]
    odd = pair(None, 188, error_deg=170.0)
    assert propose([*linked, odd], Spans(), doubtful=True)["s_via_min"] == 15
    assert propose([*linked, odd], Spans())["s_via_min"] == 188
    assert propose([*linked, odd, pair(None, 33, error_deg=50.0)], Spans(), doubtful=True)["s_via_min"] == 188


def test_too_few_pairs_are_named():
    with pytest.raises(ExperimentError, match="measure more pairs"):
        propose([pair(2.0, 30)], Spans())


def test_rules_that_stop_by_count_stop_where_no_frame_further_off_looks_as_much_alike():
    further = [pair(0.55 + 0.01 * n, 100 + n) for n in range(21)]
    near = [pair(0.45, 120), pair(0.4, 124), pair(0.35, 134)]
    proposal = propose_by_count([*near, *further, pair(1.5, 140)], Spans(), keypoints=150)
    assert proposal == {
        "s_via_min": 15,
        "s_edge_min": 20,
        "s_node_max": 110,
        "s_via_max": 124,
        "s_final": 132,
        "s_slow": 124,
        "s_max": 150,
    }


def test_rules_to_which_every_edge_is_a_way_want_one_in_twenty_shut_at_most():
    open_ways = [pair(0.6, 100), *(pair(2.0, 60) for _ in range(40))]
    shut = [replace(pair(2.0, n), is_free=False) for n in (30, 40, 70, 71)]
    near = [pair(0.3, 140)]
    assert propose_by_count([*near, *open_ways, *shut], Spans(), keypoints=150)["s_edge_min"] == 40


def test_nodes_that_follow_each_other_keep_their_edge_however_many_ways_are_shut():
    pairs = [pair(0.3, 140), *(replace(pair(0.6, 110), is_free=False) for _ in range(3))]
    assert propose_by_count(pairs, Spans(), keypoints=150)["s_edge_min"] == 80
    assert propose(pairs, Spans())["s_edge_min"] == 20


@pytest.mark.parametrize(("carries_m", "bound_m"), [(0.48, 2.0), (0.32, 3.0), (0.2, 3.0)])
def test_with_a_pipeline_that_sees_further_edges_of_a_room_are_no_longer(carries_m, bound_m):
    """So many times longer as it takes the room to be larger, and never longer than with the default one."""
    pairs = [pair(d, round(270 / (1 + d / carries_m))) for d in (0.5, 0.6, 0.7, 0.8)]
    pairs.append(pair(2.5, 200))
    assert longest_edge_m(pairs, Spans(), 300, 3.0) == pytest.approx(bound_m, rel=0.02)
    assert longest_edge_m(pairs, Spans(), 300, 0.0) == 0.0, "where edges may be of any length they still may"
