"""The latch of the emergency stop: what is kept, who may clear it, and how the two sides agree."""

import pytest

from shared.estop.latch import MOST_CHANGES, Latch
from shared.messages.estop import EStopState


@pytest.fixture
def drive(tmp_path):
    return Latch("r1", tmp_path / "drive")


@pytest.fixture
def robot(tmp_path):
    return Latch("r1", tmp_path / "robot")


def again(tmp_path, side):
    """The same side after a restart."""
    return Latch("r1", tmp_path / side)


def agree(drive, robot):
    """Both sides hear each other until neither changes."""
    for _ in range(5):
        robot.follow(drive.state)
        drive.learn(robot.state)
    assert not robot.follow(drive.state)
    assert not drive.learn(robot.state)
    assert drive.state.engaged == robot.state.engaged


def engaged(latch):
    latch.engage("anna", "a child", 5)
    latch.save()
    return latch


def test_it_is_clear_until_somebody_engages_it_and_nothing_is_written_before(drive, tmp_path):
    assert not drive.state.engaged
    assert not (tmp_path / "drive").exists()


def test_an_engaged_stop_outlives_the_process_with_who_and_why(drive, tmp_path):
    state = engaged(drive).state
    assert (state.engaged, state.who, state.why, state.since_ns) == (True, "anna", "a child", 5)
    assert again(tmp_path, "drive").state == state


def test_the_first_who_engaged_it_stays_named(drive):
    engaged(drive).engage("bert", "me too", 9)
    assert (drive.state.who, drive.state.seq) == ("anna", 1)


def test_only_a_named_person_clears_it_and_that_outlives_the_process(drive, tmp_path):
    engaged(drive)
    for nobody in ("", "  "):
        with pytest.raises(ValueError, match="name of the person"):
            drive.clear(nobody, "", 7)
    assert drive.state.engaged
    drive.clear(" bert ", "looked", 7)
    assert (drive.state.engaged, drive.state.who, drive.state.seq) == (False, "bert", 2)
    assert again(tmp_path, "drive").state == drive.state


@pytest.mark.parametrize("content", [b"", b"{", b"\xff", b"{}", b'{"robot": "r1"}', b"null"])
def test_a_file_that_cannot_be_read_means_engaged(tmp_path, content):
    (tmp_path / "estop-r1.json").write_bytes(content)
    assert Latch("r1", tmp_path).state.engaged


def test_a_folder_in_the_place_of_the_file_means_engaged(tmp_path):
    (tmp_path / "estop-r1.json").mkdir()
    assert Latch("r1", tmp_path).state.engaged


def test_a_stop_that_cannot_be_saved_holds_all_the_same_and_is_saved_later(tmp_path):
    latch = Latch("r1", tmp_path / "full")
    (tmp_path / "full").write_text("a file where the folder should be")
    latch.engage("anna", "", 5)
    with pytest.raises(OSError, match="full"):
        latch.save()
    assert latch.state.engaged
    (tmp_path / "full").unlink()
    latch.engage("bert", "", 6)
    latch.save()
    assert again(tmp_path, "full").state.who == "anna"


def test_a_clearance_that_cannot_be_saved_does_not_hold(drive, tmp_path):
    engaged(drive)
    (tmp_path / "drive/estop-r1.new").mkdir()
    with pytest.raises(OSError, match=r"estop-r1\.new"):
        drive.clear("bert", "", 7)
    assert drive.state.engaged


def test_the_robot_follows_drive_both_ways(drive, robot):
    assert robot.follow(engaged(drive).state)
    assert robot.state.engaged
    drive.clear("bert", "", 7)
    assert robot.follow(drive.state)
    assert not robot.state.engaged


def test_an_older_clear_state_does_not_let_the_robot_go(drive, robot):
    before = drive.state
    robot.follow(engaged(drive).state)
    assert not robot.follow(before)
    assert not robot.follow(EStopState(robot="r1", engaged=False, who="", seq=99))  # nobody cleared that
    assert robot.state.engaged


def test_drive_that_forgot_learns_the_stop_from_the_robot(drive, robot, tmp_path):
    robot.follow(engaged(drive).state)
    forgetful = Latch("r1", tmp_path / "new")
    agree(forgetful, robot)
    assert (forgetful.state.engaged, forgetful.state.who) == (True, "anna")
    forgetful.clear("bert", "", 7)
    agree(forgetful, robot)
    assert not robot.state.engaged


def test_a_stop_of_a_drive_that_forgot_how_often_is_followed(drive, robot, tmp_path):
    engaged(drive).clear("bert", "", 7)
    robot.follow(drive.state)
    forgetful = engaged(Latch("r1", tmp_path / "new"))
    assert robot.follow(forgetful.state)
    assert (robot.state.engaged, robot.state.seq) == (True, 3)
    agree(forgetful, robot)
    assert robot.state.engaged


@pytest.mark.parametrize("broken", ["drive", "robot"])
def test_an_unreadable_file_on_one_side_stops_both_until_a_person_clears(drive, robot, tmp_path, broken):
    engaged(drive).clear("bert", "", 7)
    robot.follow(drive.state)
    robot.save()
    (tmp_path / broken / "estop-r1.json").write_bytes(b"junk")
    drive, robot = again(tmp_path, "drive"), again(tmp_path, "robot")
    agree(drive, robot)
    assert drive.state.engaged
    drive.clear("bert", "", 9)
    agree(drive, robot)
    assert not robot.state.engaged


def test_the_robot_reporting_clear_never_clears_drive(drive):
    engaged(drive).learn(EStopState(robot="r1", engaged=False, who="bert", seq=50))
    assert drive.state.engaged
    assert drive.state.seq == 51


@pytest.mark.parametrize("side", ["drive", "robot"])
def test_a_nonsense_count_stops_and_does_not_overflow(drive, robot, side):
    huge = EStopState(robot="r1", engaged=True, who="x", seq=2**63 - 1)
    robot.follow(huge)
    assert robot.state.engaged
    drive.learn(huge)
    latch = {"drive": drive, "robot": robot}[side]
    assert latch.state.seq < MOST_CHANGES
