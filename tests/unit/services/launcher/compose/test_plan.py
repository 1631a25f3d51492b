"""Start order."""

import pytest

from services.launcher.compose.compose_file import COMPOSE_FILE, Service, load_compose
from services.launcher.compose.plan import active_services, start_stages, with_chosen


def service(*needs, profiles=()):
    return Service(command=("x",), depends_on={need: {} for need in needs}, profiles=profiles)


def test_each_stage_needs_only_earlier_ones_and_keeps_the_order_of_the_file():
    services = {"d": service("b", "c"), "c": service("a"), "b": service("a"), "a": service()}
    assert start_stages(services) == [["a"], ["c", "b"], ["d"]]


def test_the_router_starts_first_and_planner_waits_for_the_map_store():
    services = active_services(load_compose(COMPOSE_FILE, {"TOPNAV_TOKEN": ""}).services)
    rank = {name: index for index, stage in enumerate(start_stages(services)) for name in stage}
    assert rank["router"] == 0
    assert [name for name, index in rank.items() if index == 0] == ["router"]
    assert rank["map-store"] < rank["planner"]
    assert rank["map-store"] < rank["features"]
    assert set(rank) == set(services)


def test_a_circle_is_refused_with_its_members():
    with pytest.raises(ValueError, match=r"in a circle: .*a.*"):
        start_stages({"a": service("b"), "b": service("a")})


def test_a_dependency_that_will_not_run_is_named():
    with pytest.raises(ValueError, match=r"a depends on \['gone'\]"):
        start_stages({"a": service("gone")})


def test_what_is_not_required_counts_only_where_it_runs():
    optional = Service(command=("x",), depends_on={"b": {"required": False}, "c": {}})
    services = {"a": optional, "b": service(profiles=("secure",)), "c": service()}
    assert start_stages(active_services(services)) == [["c"], ["a"]]
    assert list(active_services(services, only=["a"])) == ["a", "c"]
    assert start_stages(active_services(services, profiles=["secure"])) == [["b", "c"], ["a"]]
    assert list(active_services(services, profiles=["secure"], only=["a"])) == ["a", "b", "c"]


def test_a_profile_is_off_until_chosen():
    services = {"a": service(), "b": service(profiles=("record",))}
    assert list(active_services(services)) == ["a"]
    assert list(active_services(services, profiles=["record"])) == ["a", "b"]


def test_choosing_services_brings_what_they_need():
    services = {"a": service(), "b": service("a"), "c": service("b"), "d": service("a")}
    assert list(active_services(services, only=["c"])) == ["a", "b", "c"]
    with pytest.raises(ValueError, match="no service 'z'"):
        active_services(services, only=["z"])


def test_a_real_camera_takes_the_place_of_the_simulator_and_of_no_other_body():
    simulator = Service(command=("python", "-m", "simulator"))
    services = {"simulator": simulator, "camera": service(profiles=("camera",)), "a": service()}
    assert list(active_services(with_chosen(services, {}))) == ["simulator", "a"]
    assert list(active_services(with_chosen(services, {"TOPNAV_CAMERA": ""}))) == ["simulator", "a"]
    given = {"TOPNAV_CAMERA": "osc://192.168.1.1"}
    assert list(active_services(with_chosen(services, given))) == ["camera", "a"]
    robot = services | {"simulator": Service(command=("python", "robot.py"))}
    assert list(active_services(with_chosen(robot, given))) == ["simulator", "camera", "a"]


def test_a_live_view_is_beside_the_simulator_where_a_port_is_given():
    simulator = Service(command=("python", "-m", "simulator"))
    services = {"simulator": simulator, "foxglove": service(profiles=("foxglove",)), "a": service()}
    assert list(active_services(with_chosen(services, {"TOPNAV_FOXGLOVE": ""}))) == ["simulator", "a"]
    given = {"TOPNAV_FOXGLOVE": "8765"}
    assert list(active_services(with_chosen(services, given))) == ["simulator", "foxglove", "a"]


def test_who_hands_out_the_tasks_of_a_fleet_is_beside_the_simulator_where_it_is_asked_for():
    simulator = Service(command=("python", "-m", "simulator"))
    services = {"simulator": simulator, "fleet": service(profiles=("fleet",)), "a": service()}
    assert list(active_services(with_chosen(services, {"TOPNAV_FLEET": ""}))) == ["simulator", "a"]
    given = {"TOPNAV_FLEET": "1"}
    assert list(active_services(with_chosen(services, given))) == ["simulator", "fleet", "a"]


def test_a_robot_in_ros_does_so_with_a_camera_of_its_own_or_of_topnav():
    simulator = Service(command=("python", "-m", "simulator"))
    services = {
        "simulator": simulator,
        "camera": service(profiles=("camera",)),
        "ros": service(profiles=("ros",)),
        "a": service(),
    }
    robot = {"TOPNAV_ROS": "robot.yaml"}
    assert list(active_services(with_chosen(services, {"TOPNAV_ROS": ""}))) == ["simulator", "a"]
    assert list(active_services(with_chosen(services, robot))) == ["ros", "a"]
    both = robot | {"TOPNAV_CAMERA": "osc://192.168.1.1"}
    assert list(active_services(with_chosen(services, both))) == ["camera", "ros", "a"]


def test_what_reads_signs_joins_the_simulator_when_it_is_wanted():
    simulator = Service(command=("python", "-m", "simulator"))
    services = {"simulator": simulator, "signs": service(profiles=("signs",)), "a": service()}
    assert list(active_services(with_chosen(services, {"TOPNAV_SIGNS": ""}))) == ["simulator", "a"]
    assert list(active_services(with_chosen(services, {"TOPNAV_SIGNS": "true"}))) == [
        "simulator",
        "signs",
        "a",
    ]
