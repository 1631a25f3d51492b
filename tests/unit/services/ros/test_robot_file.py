"""The robot's file: the examples, what is usual, and what is wrong by name."""

import math

import pytest

from services.ros.robot_file import RobotFileError, load_robot_file

LEAST = """
name: a robot
wire: {kind: bridge}
scan: {topic: /scan}
velocity: {topic: /cmd_vel}
limits: {forward_mps: 0.3, turn_radps: 1.0}
"""


@pytest.fixture
def load(tmp_path):
    def read(text):
        path = tmp_path / "robot.yaml"
        path.write_text(text, encoding="utf-8")
        return load_robot_file(path)

    return read


@pytest.mark.parametrize("name", ["turtlebot4", "omni", "clearpath"])
def test_the_examples_are_read(repository, name):
    file = load_robot_file(repository / "deploy/robots" / f"{name}.yaml")
    assert file.guard is not None
    assert file.guard.stop_m > file.scan.own_radius_m


def test_the_least_file_is_read_with_what_is_usual(load):
    file = load(LEAST)
    assert (file.camera, file.guard, file.missions) == (None, None, "/topnav")
    assert file.velocity.types() == ("geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist")
    assert file.limits.motion.left_mps == 0.0


def test_degrees_become_the_mount_and_the_column_that_looks_ahead(load):
    file = load(LEAST.replace("/scan}", "/scan, yaw_deg: 90}") + "camera: {topic: /p, ahead_deg: 90}\n")
    assert file.scan.mount.yaw_rad == pytest.approx(math.pi / 2.0)
    assert file.camera.ahead_share == pytest.approx(0.75)  # ahead is to the right of a middle that looks left


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (("/scan}", "scan}"), "scan.topic: .*got 'scan'"),
        (("/scan}", "/scan, colour: red}"), "scan.colour"),
        (("kind: bridge", "kind: smoke"), "wire.kind: .*'rmw_zenoh', 'bridge' or 'rclpy', got 'smoke'"),
        (("forward_mps: 0.3", "forward_mps: .nan"), "limits.forward_mps"),
        (("forward_mps: 0.3", "forward_mps: -1"), "limits.forward_mps: .*got -1"),
        (("velocity: {topic: /cmd_vel}", ""), "velocity: Field required"),
        (("limits:", "guard: {topic: /cmd_vel}\nlimits:"), "two topics expected, got /cmd_vel twice"),
        ((LEAST, "[1, 2]"), "the file: .*"),
        ((LEAST, "{"), "not valid YAML"),
        ((LEAST, ""), "the file"),
    ],
)
def test_what_is_wrong_is_named_in_one_line(load, change, named):
    with pytest.raises(RobotFileError, match=named) as caught:
        load(LEAST.replace(*change))
    assert "robot.yaml: " in str(caught.value)
    assert "\n" not in str(caught.value).strip()


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(RobotFileError, match=r"none\.yaml: cannot be read"):
        load_robot_file(tmp_path / "none.yaml")
