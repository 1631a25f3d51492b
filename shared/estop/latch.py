"""What one side remembers of the emergency stop: kept on disk, engaged by anybody, cleared by a person.

Drive service and robot each have a latch of their own, so that the stop outlives the death of either, and
they compare: `seq` counts the changes and the later state wins, but in doubt it is the engaged one. Drive
alone lets go, when a person asks; the robot lets go when drive says that a person did.
"""

import logging
import os
from pathlib import Path

from pydantic import ValidationError

from shared.messages.estop import EStopState

log = logging.getLogger(__name__)

MOST_CHANGES = 2**62
"""No button was pressed so often: a count beyond it is nonsense, and counting on from it would overflow."""

UNREADABLE = "the kept state cannot be read"


class Latch:
    """The state of one robot's stop in the file `estop-ROBOT.json` of a folder.

    No file means that it was never engaged; a file that cannot be read means engaged.
    """

    def __init__(self, robot: str, folder: Path) -> None:
        self._path = folder / f"estop-{robot}.json"
        self._saved = True
        self._unreadable = False
        self.state = self._read(robot)

    def engage(self, who: str, why: str, since_ns: int) -> None:
        """Stop; who did so first stays. It holds at once and outlives this process once it is saved."""
        if not self.state.engaged:
            self._become(self.state, engaged=True, who=who, why=why, since_ns=since_ns)

    def clear(self, who: str, why: str, since_ns: int) -> None:
        """Let go, saved before it holds.

        Raises:
            ValueError: nobody's name.
            OSError: it could not be saved; it stays engaged.
        """
        if not who.strip():
            raise ValueError("clear needs the name of the person who looked, got none")
        if not self.state.engaged:
            return
        cleared = self._changed(self.state, engaged=False, who=who.strip(), why=why, since_ns=since_ns)
        self._write(cleared)
        self.state, self._saved, self._unreadable = cleared, True, False

    def learn(self, robots: EStopState) -> bool:
        """Drive hears what the robot holds; returns whether this changed anything here.

        An engaged stop that is later than ours was forgotten here. A clear one never clears: it is only
        counted past, so that the robot takes ours for the later one.
        """
        count = _count(robots)
        if robots.engaged and not self.state.engaged:
            if count > self.state.seq:
                self._become(robots, seq=count)
                return True
            return False
        least = count if robots.engaged == self.state.engaged else count + 1
        if least > self.state.seq:
            self._become(self.state, seq=least)
            return True
        return False

    def follow(self, drives: EStopState) -> bool:
        """The robot hears drive; returns whether this changed anything here.

        Engaged always holds, even from a drive service that lost count. Clear holds when it is later than
        what stands here; for a state that could not be read no clear from before is late enough.
        """
        count = _count(drives)
        if drives.engaged:
            if self.state.engaged and not self._unreadable and count <= self.state.seq:
                return False
            self._become(drives, seq=max(count, self.state.seq + (not self.state.engaged)))
        elif self._unreadable:
            self._become(self.state, seq=max(count, self.state.seq) + 1)
        elif count > self.state.seq and (drives.who or not self.state.engaged):
            self._become(drives, seq=count)
        else:
            return False
        self._unreadable = False
        return True

    def save(self) -> None:
        """Write the state unless it is on disk already.

        Raises:
            OSError: no room, no folder, no permission.
        """
        if not self._saved:
            self._write(self.state)
            self._saved = True

    def _become(self, like: EStopState, **changes: object) -> None:
        self.state, self._saved = self._changed(like, **changes), False

    def _changed(self, like: EStopState, **changes: object) -> EStopState:
        return like.model_copy(update={"seq": self.state.seq + 1, "robot": self.state.robot, **changes})

    def _read(self, robot: str) -> EStopState:
        try:
            return EStopState.model_validate_json(self._path.read_bytes())
        except FileNotFoundError:
            return EStopState(robot=robot, engaged=False)
        except (OSError, ValidationError) as error:
            log.error("%s: %s: engaged", self._path, str(error)[:200])
            self._unreadable = True
            return EStopState(robot=robot, engaged=True, why=UNREADABLE)

    def _write(self, state: EStopState) -> None:
        """Replace the file in one step; it is on the disk, not only on its way there, when this returns."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        new = self._path.with_suffix(".new")
        with new.open("wb") as file:
            file.write(state.model_dump_json(indent=2).encode())
            file.flush()
            os.fsync(file.fileno())
        new.replace(self._path)
        folder = os.open(self._path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def _count(state: EStopState) -> int:
    return state.seq if state.seq < MOST_CHANGES else 0
