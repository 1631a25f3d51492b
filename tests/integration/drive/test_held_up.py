"""What drive reads late because it was held up itself, on a real bus and a clock of the test's own."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from services.drive.service import Drive
from services.drive.settings import DriveSettings
from shared.bus import Bus, open_bus, wait_until
from tests.integration.drive.conftest import SOON_S, Neighbours

BEGIN_S = 10.0
QUIET_S = 0.3


class Clocked:
    """A drive controller in this process that steps when it is told to, at the time it is told."""

    def __init__(self, bus: Bus, neighbours: Neighbours, state_dir: Path) -> None:
        self._bus, self._neighbours = bus, neighbours
        self._drive = Drive(DriveSettings(state_dir=state_dir), bus)

    def set_off(self) -> None:
        """Drive at BEGIN_S, with nothing left on its way."""

        def moves() -> bool:
            self._neighbours.see(1)
            self._neighbours.wish(1)
            self._drive.step(BEGIN_S)
            return self.moving()

        assert wait_until(moves, SOON_S)
        while self._bus.wait(QUIET_S):
            self._drive.step(BEGIN_S)
        self.moving()

    def step(self, now_s: float, say: Callable[[], None] | None = None) -> bool:
        """Step once `say` has arrived; whether the newest command so far moves the robot."""
        if say is not None:
            self._bus.wake.clear()
            say()
            assert self._bus.wait(SOON_S)
        self._drive.step(now_s)
        return self.moving()

    def moving(self) -> bool:
        self._neighbours.commands(0.1)
        newest = self._neighbours.newest
        return newest is not None and not newest.stands


@pytest.fixture
def drive(router_endpoint: str, neighbours: Neighbours, tmp_path: Path) -> Iterator[Clocked]:
    with open_bus(router_endpoint) as bus:
        clocked = Clocked(bus, neighbours, tmp_path)
        clocked.set_off()
        yield clocked


def test_a_heading_that_was_read_late_lives_no_longer_for_it(drive: Clocked, neighbours: Neighbours):
    assert drive.step(BEGIN_S + 0.3, lambda: neighbours.wish(2)), "it may have come 0.3 s ago and lives 0.5 s"
    for seq, now_s in enumerate((0.35, 0.4, 0.45), start=2):
        assert drive.step(BEGIN_S + now_s, lambda seq=seq: neighbours.see(seq))
    assert not drive.step(BEGIN_S + 0.52, lambda: neighbours.see(5))


def test_a_burst_after_a_cut_is_thrown_away_however_late_it_is_read(drive: Clocked, neighbours: Neighbours):
    silent_s = [BEGIN_S + 0.05 * number for number in range(1, 21)]
    assert not [drive.step(now_s) for now_s in silent_s][-1]
    healed_s = silent_s[-1] + 0.05
    drive.step(healed_s, lambda: neighbours.see(2))
    drive.step(healed_s + 0.3, lambda: neighbours.wish(2))
    assert not drive.step(healed_s + 0.31, lambda: neighbours.see(3)), "held up for longer than a burst lasts"
    for number in range(1, 5):
        drive.step(healed_s + 0.31 + 0.05 * number)
    drive.step(healed_s + 0.52, lambda: neighbours.see(4))
    assert drive.step(healed_s + 0.54, lambda: neighbours.wish(4)), "it listens again"
