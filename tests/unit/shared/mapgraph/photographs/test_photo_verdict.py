"""Photos in maps of synthetic rooms: found, ambiguous between twins, not found; and where between nodes."""

import itertools
import math

import numpy as np
import pytest

from shared.geometry.photo.plane import USUAL_RAD, focal_of, rays
from shared.geometry.sphere import lonlat_from_bearings
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.photographs.photo_matches import photo_matches
from shared.mapgraph.photographs.search import PhotoPlace
from shared.mapgraph.photographs.verdict import judged, located
from shared.messages.features import PhotoView
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch
from tests.unit.shared.geometry.photo.photo_scene import Shot, on_plane, room

SPOTS = [(0.0, 0.0), (0.7, 0.1), (0.1, 0.8), (-0.6, 0.2)]
APART_M = 20.0


def graph_of(rooms):
    """Nodes at the same spots of each room, cameras along x, all joined; rooms joined by one edge."""
    spots = [(x + APART_M * k, y) for k in range(rooms) for x, y in SPOTS]
    edges = []
    for a, b in itertools.combinations(range(len(spots)), 2):
        if a // len(SPOTS) != b // len(SPOTS) and (a, b) != (0, len(SPOTS)):
            continue
        way = np.subtract(spots[b], spots[a])
        ahead = math.atan2(way[1], way[0])
        edges.append(
            Edge(
                a=a,
                b=b,
                inliers=80,
                heading_ab_rad=ahead,
                heading_ba_rad=math.remainder(ahead + math.pi, math.tau),
                yaw_ab_rad=0.0,
                disparity_rad=0.2,
                length_m=float(np.hypot(*way)),
                traversals=1,
            )
        )
    return MapGraph([Node(node_id=k, keypoints=300) for k in range(len(spots))], edges)


def answers(shot, rooms, *, known, seed=1, wrong=0.3, less=1.0):
    """What the feature service says of the photo: the same room everywhere, in later ones `less` of it."""
    rng = np.random.default_rng(seed)
    points = room(rng)
    plane, _, shown = on_plane(points, shot)
    view = PhotoView(fov_rad=shot.fov_rad if known else USUAL_RAD, fov_known=known, aspect=shot.aspect)
    nominal = lonlat_from_bearings(rays(plane, focal_of(view.fov_rad))[0])
    found = []
    for node, (x_m, y_m) in enumerate(SPOTS * rooms):
        share = 0.35 * (1.0 if node < len(SPOTS) else less)
        rows = np.flatnonzero(shown & (rng.random(len(points)) < share))
        there = lonlat_from_bearings(points[rows] - [x_m, y_m, 0.0]) + rng.normal(0.0, 0.003, (len(rows), 2))
        bad = rng.random(len(rows)) < wrong
        there[bad] = rng.uniform(-1.0, 1.0, (bad.sum(), 2))
        found.append(
            NodeMatch(
                node_id=node,
                raw_matches=len(rows),
                inliers=0,
                status="inconsistent",
                matches_rad=np.concatenate([nominal[rows], there], axis=1).astype(np.float32),
                inlier_mask=np.zeros(len(rows), np.uint8),
                right=np.full(len(rows), 1.0 - wrong, np.float32),
            )
        )
    return photo_matches(view, found)


def ask(shot, rooms=1, **choices):
    return located(graph_of(rooms), answers(shot, rooms, **choices), np.random.default_rng(0))


def error_m(place, shot):
    x_m, y_m = SPOTS[place.node % len(SPOTS)]
    return math.hypot(x_m + place.x_m - shot.position_m[0], y_m + place.y_m - shot.position_m[1])


@pytest.mark.parametrize("known", [True, False])
def test_a_photo_between_nodes_is_found_with_its_direction(known):
    shot = Shot(position_m=(0.35, 0.4, 0.2), yaw_rad=-2.0, pitch_rad=-0.2)
    answer = ask(shot, known=known)
    assert answer.verdict == "found"
    place = answer.places[0]
    assert error_m(place, shot) < 0.3
    assert abs(math.remainder(place.yaw_rad - shot.yaw_rad, math.tau)) < math.radians(5.0)
    assert place.fov_rad == pytest.approx(shot.fov_rad, abs=math.radians(6.0))


def test_rooms_that_are_equal_are_named_both():
    answer = ask(Shot(), rooms=2, known=True)
    assert answer.verdict == "ambiguous"
    assert {place.node // len(SPOTS) for place in answer.places} == {0, 1}


def test_a_room_that_shares_a_little_with_another_is_told_from_it():
    assert ask(Shot(), rooms=2, known=True, less=0.15).verdict == "found"


def test_wrong_matches_alone_find_nothing():
    answer = ask(Shot(), known=False, wrong=0.999)
    assert (answer.verdict, answer.places) == ("not_found", ())


def test_a_known_view_is_not_looked_at_again_an_unknown_one_with_what_was_found():
    view = PhotoView(fov_rad=USUAL_RAD, fov_known=False, aspect=0.75)
    answer = judged(graph_of(1), [place(0, 0.0, 0.0, 60.0)])
    again = answer.looked_again(view)
    assert again is not None
    assert (again.fov_rad, again.fov_known) == (1.25, False)
    assert answer.looked_again(view.model_copy(update={"fov_known": True})) is None


def place(node, x_m, y_m, score, keypoints=20, yaw_rad=0.0):
    return PhotoPlace(node, x_m, y_m, 0.0, yaw_rad, 1.25, score, keypoints)


def test_poses_of_one_place_with_equal_evidence_are_weak_where_they_are_far_apart():
    far = [place(0, -0.9, 0.0, 80.0), place(1, 0.5, 0.0, 79.0)]
    answer = judged(graph_of(1), far)
    assert answer.verdict == "weak"
    near = [place(0, -0.2, 0.0, 80.0), place(0, 0.2, 0.0, 80.0)]
    middle = judged(graph_of(1), near)
    assert middle.verdict == "found"
    assert (middle.places[0].node, middle.places[0].x_m) == (0, pytest.approx(0.0, abs=1e-6))


@pytest.mark.parametrize(("score", "keypoints"), [(29.0, 10), (60.0, 7), (45.0, 40)])
def test_little_evidence_few_keypoints_or_many_poor_ones_are_no_claim(score, keypoints):
    assert judged(graph_of(1), [place(0, 0.0, 0.0, score, keypoints)]).verdict == "not_found"
    assert judged(graph_of(1), [place(0, 0.0, 0.0, 60.0, 20)]).verdict == "found"


def test_a_weak_look_alike_counts_as_a_rival_though_it_is_no_claim_by_itself():
    answer = judged(graph_of(2), [place(0, 0.0, 0.0, 48.0, 10), place(4, 0.0, 0.0, 27.0, 8)])
    assert answer.verdict == "ambiguous"
