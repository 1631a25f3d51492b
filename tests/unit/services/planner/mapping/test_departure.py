"""Leaving a node: its view keeps the course, unless it is that of a look-alike."""

import math

import pytest

from services.planner.mapping.departure import UNSURE_FRAMES, Departure, NewNode
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import ROOM_HALF_M
from shared.messages.maps import Edge, Node
from shared.messages.sensors import Ranges
from shared.motion.motion import Motion
from tests.unit.services.planner.travel.seen import Maps, by_node, features, match
from tests.unit.shared.mapgraph.local.places import inliers_at

STEP = Motion(0.12, 0.0)
ANGLES_RAD = tuple(math.radians(30 * n) for n in range(12))
RANGES = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(4.0,) * 12, max_range_m=4.0)


class Matcher:
    """Shows one node, and another one that looks alike to whoever asks for the most similar ones."""

    def __init__(self):
        self.seen = match(0, 0.0, 0.0)
        self.look_alike = self.also = None

    def match(self, node_ids, best_k=0, targets=()):  # noqa: ARG002
        alike = [self.look_alike] if best_k and self.look_alike is not None else []
        return by_node(self.seen, *alike, *([self.also] if self.also is not None else []))


@pytest.fixture
def matcher():
    return Matcher()


@pytest.fixture
def departure(matcher):
    """Straight ahead from node 0, whose camera looks along x as the robot's does."""
    maps = Maps(MapGraph([Node(node_id=node, open=(True,) * 12) for node in (0, 7)]))
    return Departure(DEFAULT, maps, matcher, 0, 0.0, Displacement(0), FloorViews(0.27))


def drive(departure, matcher, view):
    matcher.seen = view
    return departure.step(Observation(features(), RANGES, STEP))


def behind(away_m, yaw_rad=0.0, confidence=0.9):
    sight = match(0, -away_m, 0.0, DEFAULT.mapping.s_node_max + 20)
    return sight.model_copy(update={"yaw_rad": yaw_rad, "confidence": confidence})


def test_the_view_of_the_node_left_keeps_the_course(departure, matcher):
    for step in range(1, 6):
        decision = drive(departure, matcher, behind(0.12 * step, yaw_rad=0.05))
    assert decision.heading_rad == pytest.approx(0.05)
    assert departure.here.yaw_rad == pytest.approx(-0.05)


@pytest.mark.parametrize("confidence", [0.9, 0.3])
def test_a_node_seen_as_if_the_robot_had_turned_at_once_is_a_look_alike(departure, matcher, confidence):
    """The two sides of a desk island: half a turn, and all else fits."""
    for step in range(1, 4):
        drive(departure, matcher, behind(0.12 * step))
    where = departure.here
    decision = drive(departure, matcher, behind(0.48, yaw_rad=math.pi, confidence=confidence))
    assert decision.why.startswith("out of sight")
    assert abs(decision.heading_rad) == pytest.approx(math.pi), "back on the way it came"
    assert departure.here.yaw_rad == where.yaw_rad
    assert departure.here.x_m == pytest.approx(where.x_m + STEP.x_m)


def test_an_unsure_bearing_does_not_say_where_the_robot_is(departure, matcher):
    for step in range(1, 5):
        drive(departure, matcher, behind(0.12 * step))
    drive(departure, matcher, match(0, 0.6, 0.0).model_copy(update={"confidence": 0.4}))
    assert departure.here.x_m == pytest.approx(0.6, abs=0.01)


def test_a_bearing_far_from_where_the_commands_led_is_wrong_however_sure(departure, matcher):
    for step in range(1, 4):
        drive(departure, matcher, behind(0.12 * step))
    wild = match(0, -0.48 * math.cos(math.radians(55.0)), -0.48 * math.sin(math.radians(55.0)))
    drive(departure, matcher, wild)
    assert (departure.here.x_m, departure.here.y_m) == pytest.approx((0.48, 0.0), abs=0.01)


def test_views_that_change_fast_make_no_crowd_of_nodes(departure, matcher):
    """Beside a repeating desk S falls within 0.3 m."""
    found = [drive(departure, matcher, unlike(0.12 * step)) for step in range(1, 6)]
    assert [isinstance(one, NewNode) for one in found] == [False] * 4 + [True]


def test_a_room_furnished_like_another_is_new(departure, matcher):
    """However alike a node elsewhere looks, it does not make this place known."""
    matcher.look_alike = match(7, 3.0, 0.0, 200).model_copy(update={"confidence": 0.3})
    found = [drive(departure, matcher, unlike(0.12 * step)) for step in range(1, 6)]
    assert isinstance(found[-1], NewNode), found[-1].why


@pytest.fixture
def beside():
    """A departure straight ahead that begins 0.4 m to the left of its node."""
    maps = Maps(MapGraph([Node(node_id=0, open=(True,) * 12)]))
    return Departure(DEFAULT, maps, Matcher(), 0, 0.0, Displacement(0, y_m=0.4), FloorViews(0.27))


def walled(beside):
    """Frames beside node 0 with a jamb close ahead, until the robot stands at the node."""
    jamb = RANGES.model_copy(update={"distances_m": (0.3, 0.3, *RANGES.distances_m[3:], 0.3)})
    first = beside.step(Observation(features(), jamb, Motion(0.0, 0.0)))
    second = beside.step(Observation(features(), jamb, Motion(0.0, -0.12)))
    return [first, second], jamb


def test_a_direction_blocked_beside_its_node_is_left_from_the_node_itself(beside):
    on_the_way, _ = walled(beside)
    assert [decision.heading_rad for decision in on_the_way] == pytest.approx([-math.pi / 2] * 2, abs=0.2)
    at_the_node = beside.step(Observation(features(), RANGES, Motion(0.0, -0.12)))
    assert at_the_node.heading_rad == pytest.approx(0.0)
    assert not beside.done


def test_a_direction_blocked_at_its_node_too_is_closed(beside):
    _, jamb = walled(beside)
    beside.step(Observation(features(), jamb, Motion(0.0, -0.12)))
    assert beside.done


@pytest.mark.parametrize(("aside_m", "explored"), [(0.0, True), (-0.6, False)])
def test_a_new_node_closes_the_direction_it_lies_in(matcher, aside_m, explored):
    """What begins beside its node and makes a node there has not gone in the direction."""
    maps = Maps(MapGraph([Node(node_id=0, open=(True,) * 12)]))
    departure = Departure(
        DEFAULT, maps, matcher, 3, math.pi / 2, Displacement(0, aside_m, 0.05), FloorViews(0.27)
    )
    found = []
    while not isinstance(found, NewNode):
        matcher.seen = match(0, -departure.here.x_m, -departure.here.y_m, 60)
        matcher.seen = matcher.seen.model_copy(update={"confidence": 0.9})
        found = departure.step(Observation(features(), RANGES, Motion(0.0, 0.12)))
    assert maps.graph.nodes[0].explored[3] == explored


def unlike(away_m):
    sight = match(0, -away_m, 0.0, DEFAULT.mapping.s_node_max - 20)
    return sight.model_copy(update={"confidence": 0.9})


def test_a_view_without_a_sure_direction_is_driven_on_from_and_given_up_in_the_end(departure, matcher):
    """Along a corrugated wall nodes are recognised, but from where is not to be told."""
    vague = [unlike(0.12 * step).model_copy(update={"confidence": 0.4}) for step in range(1, 30)]
    found = []
    while not departure.done:
        found.append(drive(departure, matcher, vague[len(found)]))
    on = [one for one in found if one.method == "frontier"]
    assert len(on) > UNSURE_FRAMES
    assert found[-1].method == "reverse"


@pytest.mark.parametrize(("covers_m", "carries"), [(None, 1), (1.0, 2)])
def test_a_node_is_made_at_the_end_of_a_long_way_though_one_far_off_is_still_like_it(
    matcher, covers_m, carries
):
    """Between containers the view of the node before the last came back; in a hall all views carry far."""
    behind_0 = Edge(
        a=0, b=7, inliers=150, heading_ab_rad=math.pi, heading_ba_rad=0.0, yaw_ab_rad=0.0, length_m=0.3
    )
    maps = Maps(MapGraph([Node(node_id=node, open=(True,) * 12) for node in (0, 7)], [behind_0]))
    profile = DEFAULT.replaced(covers_m=covers_m)
    departure = Departure(profile, maps, matcher, 0, 0.0, Displacement(0), FloorViews(0.27))
    step = 0
    found = None
    while not departure.done and not isinstance(found, NewNode):
        step += 1
        matcher.also = match(7, -0.3 - 0.12 * step, 0.0, 95)
        inliers = inliers_at(0.12 * step, carries * ROOM_HALF_M)
        found = drive(departure, matcher, match(0, -0.12 * step, 0.0, inliers))
    assert isinstance(found, NewNode), found.why
    assert 0.12 * step == pytest.approx(DEFAULT.mapping.departure_m, abs=0.2)


def test_a_way_past_nodes_that_stay_near_is_closed(departure, matcher):
    still = Observation(features(), RANGES, Motion(0.12, 0.0))
    matcher.seen = match(0, -0.3, 0.0, 150)
    departure.near.here = Displacement(0, x_m=-1.3)
    while not departure.done:
        departure.near.here = Displacement(0, x_m=0.3)
        decision = departure.step(still)
    assert decision.why == "nothing new on the way"
