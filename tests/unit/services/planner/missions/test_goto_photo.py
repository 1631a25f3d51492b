"""A mission to a photo: to its place, turned as it looks, or a typed failure; on a true floor plan."""

import copy
import math

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.mission_kinds import MissionContext, MissionError
from services.planner.missions.goto import KIND
from services.planner.profiles import DEFAULT
from shared.geometry.perspective import rotation_z
from shared.geometry.photo.plane import focal_of, rays
from shared.geometry.sphere import lonlat_from_bearings
from shared.messages.features import PhotoView
from shared.messages.matching import NodeMatch
from shared.messages.places import KeepOut, Place, PutPlace, PutRule
from tests.plane_world import PlaneMap, PlaneMatcher, picture, run
from tests.unit.shared.geometry.photo.photo_scene import Shot, on_plane

START, SPOT = (2.6, 1.3, 0.0), (1.1, 3.6)
VIEW = PhotoView(fov_rad=1.25, fov_known=True, aspect=4 / 3)


class SeenMap(PlaneMap):
    """The map, which also says what a node looks like."""

    def features_of(self, node_id):
        return picture(self.poses[node_id])


class PhotoMatcher(PlaneMatcher):
    """Matches a photo taken at `shot` by points around it that nodes near by see as well."""

    def __init__(self, world, maps, shot, share=0.35):
        super().__init__(world, maps)
        self._nodes, self._shot, self._share = maps.poses, shot, share

    def locate(self, features, best_k, node_ids=(), *, with_differences=False):
        if features.photo is None:
            return super().locate(features, best_k, node_ids, with_differences=with_differences)
        rng = np.random.default_rng(5)
        around = rng.uniform(-4.0, 4.0, (900, 3)) * [1.0, 1.0, 0.35]
        points = around + np.array([*self._shot.position_m[:2], 0.0])
        plane, _, shown = on_plane(points, self._shot)
        photo = lonlat_from_bearings(rays(plane, focal_of(VIEW.fov_rad))[0])
        return {node: self._match(rng, node, points, photo, shown) for node in self._nodes}

    def _match(self, rng, node, points, photo, shown):
        x_m, y_m, yaw_rad = self._nodes[node]
        far_m = math.dist((x_m, y_m), self._shot.position_m[:2])
        share = self._share / (1.0 + (far_m / 1.5) ** 4)
        rows = np.flatnonzero(shown & (rng.random(len(points)) < share))
        there = lonlat_from_bearings((points[rows] - [x_m, y_m, 0.0]) @ rotation_z(yaw_rad))
        return NodeMatch(
            node_id=node,
            raw_matches=len(rows),
            inliers=len(rows),
            status="inconsistent",
            matches_rad=np.concatenate([photo[rows], there], axis=1).astype(np.float32),
            inlier_mask=np.zeros(len(rows), np.uint8),
            right=np.full(len(rows), 0.8, np.float32),
        )


@pytest.fixture(scope="module")
def mapped(explorations):
    found = explorations(2)
    return found.world, SeenMap(found.maps.graph, found.maps.poses)


def goto(maps, matcher):
    goal = picture(START).model_copy(update={"photo": VIEW})
    context = MissionContext(DEFAULT, maps, matcher, np.random.default_rng(1), goal)
    return KIND.start(context, {})


@pytest.mark.parametrize("yaw_rad", [0.5, -2.4])
def test_the_robot_drives_to_where_a_photo_was_taken_and_looks_as_it_does(mapped, yaw_rad):
    world, maps = mapped
    world.pose = START
    shot = Shot(position_m=(*SPOT, 0.2), yaw_rad=yaw_rad, fov_rad=VIEW.fov_rad)
    decision, _ = run(world, goto(maps, PhotoMatcher(world, maps, shot)), DriveLimits(), 900)
    assert (decision.outcome, decision.failure) == ("succeeded", "")
    assert math.dist(world.pose[:2], SPOT) < 0.5
    assert abs(math.remainder(world.pose[2] - yaw_rad, math.tau)) < math.radians(8.0)


def test_a_photo_that_the_map_does_not_explain_fails_at_once_and_moves_nothing(mapped):
    world, maps = mapped
    world.pose = START
    nothing = PhotoMatcher(world, maps, Shot(position_m=(*SPOT, 0.2)), share=0.002)
    decision, steps = run(world, goto(maps, nothing), DriveLimits(), 900)
    assert (decision.outcome, decision.failure, steps) == ("failed", "goal_not_in_map", 0)
    assert world.pose == START


@pytest.fixture
def ruled(mapped):
    """The same map, to make rules on."""
    world, maps = mapped
    world.pose = START
    return world, SeenMap(copy.deepcopy(maps.graph), maps.poses)


def forbid(maps, node):
    maps.commit([PutRule(rule=KeepOut(name="exhibition", nodes=(node,)))])


def nearest_nodes(maps):
    return sorted(maps.poses, key=lambda node: math.dist(maps.poses[node][:2], SPOT))


@pytest.mark.parametrize("rank", [0, 1])
def test_a_photo_taken_in_a_keep_out_or_beside_it_is_refused_by_the_rules_name(ruled, rank):
    world, maps = ruled
    forbid(maps, nearest_nodes(maps)[rank])
    photo = PhotoMatcher(world, maps, Shot(position_m=(*SPOT, 0.2), fov_rad=VIEW.fov_rad))
    decision, steps = run(world, goto(maps, photo), DriveLimits(), 900)
    assert (decision.outcome, decision.failure, steps) == ("failed", "forbidden", 0)
    assert "'exhibition'" in decision.why
    assert world.pose == START


def test_a_rule_that_comes_on_the_last_metre_ends_the_mission(ruled):
    world, maps = ruled
    mission = goto(maps, PhotoMatcher(world, maps, Shot(position_m=(*SPOT, 0.2), fov_rad=VIEW.fov_rad)))

    class RuledLate:
        progress = mission.progress

        def decide(self, observation):
            decision = mission.decide(observation)
            if "nearest node" in decision.why:
                forbid(maps, nearest_nodes(maps)[0])
            return decision

    decision, _ = run(world, RuledLate(), DriveLimits(), 900)
    assert (decision.outcome, decision.failure) == ("failed", "forbidden")
    assert "'exhibition'" in decision.why


@pytest.mark.parametrize("given", [{"place": "dock"}, {"goal_node": 0}])
def test_a_photo_is_no_goal_beside_another_one(ruled, given):
    world, maps = ruled
    maps.commit([PutPlace(place=Place(name="dock", nodes=(0,)))])
    context = MissionContext(
        DEFAULT,
        maps,
        PlaneMatcher(world, maps),
        np.random.default_rng(1),
        picture(START).model_copy(update={"photo": VIEW}),
    )
    with pytest.raises(MissionError, match="exactly one of them"):
        KIND.start(context, given)
