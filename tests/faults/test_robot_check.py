"""`topnav robot check` on a robot in ROS 2: a good one passes, and of a bad one the fault is named."""

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from PIL import Image

from experiments.ros_robot import body
from experiments.ros_robot.messages import picture_of, scan_of
from experiments.ros_robot.robot import RosRobot, running_stack
from services.launcher.checking.check import RobotCheck
from services.launcher.client.experimenter import Experimenter
from services.launcher.client.hand import Hand
from services.launcher.client.stack import Stack, StackChoice
from services.launcher.client.trail import driven_m
from services.ros.conversions.twist import motion_of
from shared.bus import wait_until
from shared.messages.simulation import Pose
from shared.topics import RANGES, TRUTH
from tests.integration.ros.conftest import ROS_PYTHON
from tests.theta_robot import IN_ROS, domain

pytestmark = [*IN_ROS, pytest.mark.timeout(900)]

SMALL_PICTURES = {"SIMULATOR_WIDTH_PX": "1024"}
SOON_S = 60.0
NS = 1_000_000_000


@dataclass
class Checked:
    """A check and what it said."""

    check: RobotCheck
    lines: list[tuple[str, str]]

    @property
    def text(self) -> str:
        return "\n".join(f"{word} {text}" for word, text in self.lines)


@pytest.fixture(scope="module")
def stack(tmp_path_factory) -> Iterator[Stack]:
    """A stack whose robot is in ROS, where there is room all round."""
    folder = tmp_path_factory.mktemp("robot")
    robot = RosRobot(folder / "robot", "apartment", 1, domain(), ROS_PYTHON, SMALL_PICTURES)
    with running_stack(robot, StackChoice(folder / "data", seed=1)) as opened:
        yield opened


@pytest.fixture
def checked(stack) -> Checked:
    """A check of the robot, which stands at the world's start and sees again."""
    ranges = stack.bus.subscribe(RANGES, robot=stack.robot)
    reset_ns = Experimenter(stack.bus, stack.robot).reset(1).stamp_ns
    assert wait_until(lambda: (one := ranges.take()) is not None and one.stamp_ns > reset_ns, SOON_S)
    lines = []
    logs = stack.launcher.logs
    return Checked(RobotCheck(stack.bus, stack.robot, "anna", logs, lambda *line: lines.append(line)), lines)


def changed(edit):
    """Pictures as a camera delivers them that is mounted otherwise."""

    def made(codec, frame):
        picture = np.asarray(Image.open(io.BytesIO(frame.data)))
        file = io.BytesIO()
        Image.fromarray(np.ascontiguousarray(edit(picture))).save(file, "JPEG", quality=92)
        return picture_of(codec, frame.model_copy(update={"data": file.getvalue()}))

    return made


def test_a_good_robot_passes_and_ends_where_it_began(stack, checked):
    assert checked.check.senses(), checked.text
    truths = stack.bus.subscribe(TRUTH, robot=stack.robot)
    checked.check.moves()
    checked.check.stops()
    assert checked.check.problems == [], checked.text
    way = truths.take_all()
    assert driven_m(way) > 1.0
    assert driven_m([way[0], way[-1]]) < 0.3
    assert checked.check.figures["stop_estop_s"] <= 0.5


def test_a_move_that_a_pause_cut_short_is_made_again(monkeypatch, checked):
    """The machine paused, and of 0.2 m to the right 0.07 were driven: a good base was called wrong."""
    whole, cut = Hand.move, []

    def move(hand, forward_mps, left_mps, turn_radps, seconds):
        if left_mps < 0.0 and not cut:
            cut.append(seconds)
            seconds /= 4.0
        return whole(hand, forward_mps, left_mps, turn_radps, seconds)

    monkeypatch.setattr(Hand, "move", move)
    checked.check.moves()
    assert checked.check.problems == [], checked.text
    assert len([text for word, text in checked.lines if word == "move" and text.startswith("right")]) == 2


@pytest.mark.parametrize(
    ("edit", "named"),
    [
        (lambda picture: picture[:, ::-1], "left and right are swapped in the picture"),
        (lambda picture: picture[::-1, ::-1], "upside down"),
        (
            lambda picture: np.roll(picture, picture.shape[1] // 4, axis=1),
            r"\b(8[89]|9[012]) degrees to the left",
        ),
    ],
    ids=["mirrored", "upside down", "turned"],
)
def test_a_camera_that_is_mounted_otherwise_is_named(monkeypatch, checked, edit, named):
    monkeypatch.setattr(body, "picture_of", changed(edit))
    assert checked.check.senses(), checked.text
    checked.check.moves()
    assert any(re.search(named, one) for one in checked.check.problems), checked.text


def test_a_base_whose_sideways_axis_is_reversed_is_named(monkeypatch, checked):
    def reversed_(message, kind):
        motion = motion_of(message, kind)
        return replace(motion, left_mps=-motion.left_mps)

    monkeypatch.setattr(body, "motion_of", reversed_)
    assert checked.check.senses(), checked.text
    checked.check.moves()
    assert any("sideways axis is reversed" in one for one in checked.check.problems), checked.text


def nan_scan(codec, ranges):
    message = scan_of(codec, ranges)
    message.ranges = np.full_like(message.ranges, np.nan)
    return message


def late_clock(codec, frame):
    return picture_of(codec, frame.model_copy(update={"stamp_ns": frame.stamp_ns + 60 * NS}))


@pytest.mark.parametrize(
    ("what", "fault", "named"),
    [
        ("scan_of", nan_scan, "0 of 12 readings are some"),
        ("picture_of", changed(lambda picture: picture[:, : picture.shape[0] * 4 // 3]), "exactly 2:1"),
        ("picture_of", late_clock, r"clock jumped by \+(60|59\.[5-9])"),  # less what it was late
    ],
    ids=["NaN scans", "4:3 pictures", "clock jumps"],
)
def test_what_cannot_be_used_is_named_in_a_line_and_nothing_moves(
    stack, monkeypatch, checked, what, fault, named
):
    sent = []

    def faulty(codec, message):
        sent.append(message)
        return fault(codec, message)

    monkeypatch.setattr(body, what, faulty)
    assert wait_until(lambda: len(sent) > 2, SOON_S)  # what was sent sound has arrived by then
    truths = stack.bus.subscribe(TRUTH, robot=stack.robot)
    assert checked.check.senses() == (fault is late_clock)
    assert re.search(named, checked.text)
    assert max(truth.speed_mps for truth in truths.take_all()) < 0.01


def mirrored_scan(codec, ranges):
    message = scan_of(codec, ranges)
    message.ranges = np.roll(message.ranges[::-1], 1)
    return message


@pytest.mark.parametrize(
    ("made", "sectors", "named"),
    [(scan_of, (0, 3), ""), (mirrored_scan, (0, 9), "scan.upside_down of the robot's file is wrong")],
    ids=["right", "mirrored"],
)
def test_boxes_ahead_and_at_the_left_show_how_the_scanner_sits(
    stack, monkeypatch, checked, made, sectors, named
):
    monkeypatch.setattr(body, "scan_of", made)
    experimenter = Experimenter(stack.bus, stack.robot)
    robot, placed = experimenter.truth().pose, []

    def put(what):
        if placed:
            experimenter.set_item(placed.pop(), present=False)
        turned = {"straight ahead": 0.0, "at the robot's left": np.pi / 2}
        for where_rad in [rad for words, rad in turned.items() if words in what]:
            towards = robot.yaw_rad + where_rad
            pose = Pose(
                x_m=robot.x_m + 0.8 * np.cos(towards), y_m=robot.y_m + 0.8 * np.sin(towards), yaw_rad=0.0
            )
            placed.append("box_left" if where_rad else "box_ahead")
            experimenter.place_obstacle("basket", pose, placed[-1])

    checked.check.boxes(put)
    figures = checked.check.figures
    assert (figures["box_ahead_sector"], figures["box_left_sector"]) == sectors, checked.text
    assert named in "".join(checked.check.problems)
    assert bool(checked.check.problems) == bool(named)
