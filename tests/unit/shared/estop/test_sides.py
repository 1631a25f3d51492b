"""Drive's and the robot's side of the emergency stop, on a real bus."""

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from shared.bus import Bus, open_bus, wait_until
from shared.estop.latch import Latch
from shared.estop.sides import HEARTBEAT_S, EStopServer, RobotEStop
from shared.messages.estop import EStopRequest
from shared.queries import AbsentError, RefusedError
from shared.topics import ESTOP

SOON_S = 30.0


@pytest.fixture
def here(router_endpoint: str) -> Iterator[Bus]:
    """Drive's peer."""
    with open_bus(router_endpoint) as bus:
        yield bus


@pytest.fixture
def there(router_endpoint: str) -> Iterator[Bus]:
    """That of the robot and of whoever asks."""
    with open_bus(router_endpoint) as bus:
        yield bus


def engage(bus: Bus) -> str:
    """Ask until drive is found; returns why it objects, "" where it does not."""
    for _ in range(60):
        try:
            bus.ask(ESTOP, EStopRequest(action="engage", who="anna"), SOON_S, robot="r1")
        except AbsentError:
            time.sleep(0.1)
        except RefusedError as error:
            return str(error)
        else:
            return ""
    raise AssertionError("drive was never found")


def test_a_stop_that_could_not_be_saved_is_saved_by_both_sides_as_soon_as_it_can_be(here, there, tmp_path):
    folders = tmp_path / "drive", tmp_path / "robot"
    drive, robot = EStopServer(here, "r1", folders[0]), RobotEStop(there, "r1", folders[1])
    for folder in folders:
        folder.write_text("in the way")
    now_s = 100.0
    with ThreadPoolExecutor(1) as pool:
        answer = pool.submit(engage, there)

        def stopped() -> bool:
            drive.step(now_s)
            engaged = robot.engaged()
            robot.tell(now_s)
            return engaged and answer.done()

        assert wait_until(stopped, SOON_S)
        assert "cannot be saved" in answer.result()
    for folder in folders:
        folder.unlink()
    drive.step(now_s + HEARTBEAT_S / 2)
    assert not folders[0].exists(), "not at every step: a full disk is not to be hammered"
    drive.step(now_s + 1.1 * HEARTBEAT_S)
    robot.tell(now_s + 1.1 * HEARTBEAT_S)
    for folder in folders:
        assert Latch("r1", folder).state.engaged, "it outlives a restart"
