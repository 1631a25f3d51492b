"""Furniture that an experimenter moves while the world runs: felt and hit at once."""

import math

import pytest

from shared.messages.simulation import Pose, SimulationRequest
from simulator.experimenter import Experimenter, RequestError
from simulator.outbox import MessageMaker
from simulator.service_settings import SimulatorSettings
from simulator.settings import RangeSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.changes import ChangeError, item_names
from simulator.world.world_file import WorldFile

BAR = {"kind": "bookshelf", "at_m": [3.5, 2.0], "yaw_deg": 180, "options": {"width_m": 1.2}}


@pytest.fixture(scope="module")
def world(room_data) -> WorldFile:
    """The plain room with a shelf called gate ahead of the start."""
    furniture = [*room_data["furniture"], {**BAR, "name": "gate"}]
    return WorldFile.model_validate({**room_data, "furniture": furniture})


@pytest.fixture
def simulation(world):
    return Simulation(world, SimulationSettings(render=False, ranges=RangeSettings(noise_m=0.0)), seed=3)


@pytest.fixture
def ask(simulation):
    settings = SimulatorSettings()
    experimenter = Experimenter(simulation, MessageMaker(simulation, settings), settings.seed)
    return lambda **request: experimenter.handle(SimulationRequest(**request), 0, 0)


def drive_ahead(simulation, seconds=4.0):
    simulation.reset(1)
    simulation.command(0.48)
    simulation.step(seconds)
    return simulation.truth()


def test_light_needs_a_time_of_day(ask):
    with pytest.raises(RequestError, match="needs the time of day"):
        ask(action="set_light")
    _, changed = ask(action="set_light", illumination=0.5)
    assert changed, "the frame in flight shows the light before"


def test_items_without_a_name_are_numbered_by_kind(world):
    assert item_names(world) == ["dining_table-1", "gate"]


def test_closed_gate_blocks_sonar_and_robot_and_opens_again(simulation):
    closed_m = simulation.ranges()[0]
    assert closed_m < 1.6
    stopped = drive_ahead(simulation)
    assert stopped.collisions == 1
    simulation.set_item("gate", present=False)
    simulation.reset(1)
    assert simulation.ranges()[0] > closed_m + 1.0
    passed = drive_ahead(simulation)
    assert passed.collisions == 0
    assert passed.x_m > stopped.x_m + 0.5
    simulation.place_robot(2.0, 2.0, 0.0)
    simulation.set_item("gate", present=True)
    assert simulation.ranges()[0] == closed_m


def test_robot_time_and_collisions_go_on_when_the_world_changes(simulation):
    simulation.command(0.32)
    simulation.step(0.5)
    before = simulation.truth()
    simulation.set_item("gate", present=False)
    after = simulation.truth()
    assert (after.x_m, after.y_m, after.time_s) == (before.x_m, before.y_m, before.time_s)
    assert after.speed_mps == 0.0


def test_item_moves_and_obstacle_appears(simulation):
    simulation.set_item("gate", pose=(4.5, 1.0, math.pi))
    far_m = simulation.ranges()[0]
    simulation.place_obstacle("basket", (3.0, 2.0, 0.0))
    assert simulation.ranges()[0] < min(1.1, far_m)
    simulation.set_item("obstacle-1", present=False)
    assert simulation.ranges()[0] == far_m


def test_nothing_can_be_put_into_the_robot(simulation):
    before = tuple(simulation.ranges())
    with pytest.raises(ChangeError, match="stand in the robot"):
        simulation.place_obstacle("basket", (2.1, 2.0, 0.0))
    simulation.reset(3)
    assert tuple(simulation.ranges()) == before


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"action": "set_item"}, "needs the item's name"),
        ({"action": "set_item", "item": "gate"}, "needs present .* or a pose"),
        (
            {"action": "set_item", "item": "door-7", "present": False},
            "no item 'door-7'; it has dining_table-1",
        ),
        ({"action": "place_obstacle", "pose": Pose(x_m=3.0, y_m=2.0, yaw_rad=0.0)}, "needs a kind"),
        ({"action": "place_obstacle", "kind": "basket"}, "needs a pose"),
        (
            {"action": "place_obstacle", "kind": "wall", "pose": Pose(x_m=3.0, y_m=2.0, yaw_rad=0.0)},
            "unknown kind 'wall'",
        ),
        (
            {
                "action": "place_obstacle",
                "kind": "basket",
                "item": "gate",
                "pose": Pose(x_m=3.0, y_m=1.0, yaw_rad=0.0),
            },
            "'gate' is there already",
        ),
        (
            {"action": "set_item", "item": "gate", "pose": Pose(x_m=30.0, y_m=1.0, yaw_rad=0.0)},
            "must lie inside",
        ),
    ],
)
def test_requests_that_cannot_be_carried_out_are_refused(ask, request_, says):
    with pytest.raises(RequestError, match=says):
        ask(**request_)


def test_change_by_request_voids_the_frame_in_flight(ask, simulation):
    _, changed = ask(action="set_item", item="gate", present=False)
    assert changed
    assert "gate" not in item_names(simulation.world)
    assert ask(action="truth")[1] is False
