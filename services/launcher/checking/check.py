"""The check of a robot, one step after the other: what it senses, whether it moves as told, how it stops."""

import threading
import time
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from services.camera.checking.report import lines as camera_lines
from services.camera.checking.report import problems as camera_problems
from services.camera.checking.robot_frames import look_at
from services.launcher.checking import distances, moving, report
from services.launcher.checking.looking import Looked, Looker, last_words
from services.launcher.checking.motion import MOVES, Move, Seen, falls_short, motion_problems
from services.launcher.client.failure import ExperimentError
from services.launcher.client.hand import Hand
from shared.bus import Bus
from shared.messages.estop import EStopRequest
from shared.messages.missions import MissionRequest
from shared.queries import AbsentError
from shared.topics import ESTOP, MISSION

LOOK_S, BOX_S, ASK_S = 4.0, 1.5, 5.0
ROOM_M = 0.65
"""Free distance that a move needs: the body, its way, and what drive keeps from things; chosen."""
STOP_MPS, STOP_DRIVE_S = 0.15, 1.0
LEAST_PICTURES = 2
BEFORE_S = 3.0
"""What was complained of so long before is of now; chosen."""
TOLD = ("camera", "rate", "frames", "level", "seam", "coverage")
SERVICES = {
    "ros": "the robot in ROS",
    "camera": "the camera",
    "features": "features",
}

Say = Callable[[str, str], None]
"""Shows a word and what is so."""


class RobotCheck:
    """Checks one robot of a running stack.

    Args:
        bus: of the stack.
        robot: its name.
        who: the person who stands beside it.
        logs: the launcher's, or a folder that is not there.
        say: shows what was found, while it is found.
    """

    def __init__(self, bus: Bus, robot: str, who: str, logs: Path, say: Say) -> None:
        self._bus, self._robot, self._who, self._logs, self._say = bus, robot, who, logs, say
        self._looker = Looker(bus, robot)
        self._began_s = time.time()
        self.problems: list[str] = []
        self.figures: dict[str, Any] = {"robot": robot}
        self.picture: bytes | None = None

    def senses(self) -> bool:
        """Look at pictures and distances; False where there is too little for anything else."""
        looked = self._looker.look(LOOK_S)
        self._pictures(looked)
        if looked.ranges:
            self._say(*report.ranges_line(looked.ranges, LOOK_S))
        most_m = looked.ranges[-1].max_range_m if looked.ranges else 0.0
        self._wrong(distances.range_problems([one.distances_m for one in looked.ranges], most_m))
        told_m = [] if not looked.ranges else list(looked.ranges[-1].distances_m)
        self.figures |= {"distances_m": told_m, "distances_hz": len(looked.ranges) / LOOK_S}
        enough = len(looked.frames) >= LEAST_PICTURES and bool(looked.ranges)
        told = last_words(self._logs, SERVICES, self._began_s - BEFORE_S)
        if not enough:
            self._wrong(told)
        for one in told if enough else []:
            self._say("log", one)
        return enough

    def boxes(self, ask: Callable[[str], None]) -> None:
        """Have a person put a box ahead and one at the left, and see where it comes nearer."""
        ask("nothing within a metre and a half ahead of the robot and at its left")
        free_m = self._distances()
        ask("a box half a metre to a metre straight ahead")
        ahead = distances.nearer_sector(free_m, self._distances())
        ask("the box not ahead but at the robot's left, half a metre to a metre away")
        left = distances.nearer_sector(free_m, self._distances())
        ask("the box away")
        self.figures |= {"box_ahead_sector": ahead, "box_left_sector": left}
        self._say("boxes", f"ahead: sector {ahead}, at the left: sector {left} (0 and 3 expected)")
        self._wrong(distances.box_problems(ahead, left))

    def moves(self) -> list[Seen]:
        """Go 0.2 m each way where there is room, and turn a little, both ways.

        Raises:
            ExperimentError: a mission runs, there is no room anywhere, or nobody obeys.
        """
        self._require_idle()
        seen: list[Seen] = []
        for move in MOVES:
            if self._has_room(move):
                seen.append(self._moved(move))
        if all(one.move.turn_rad for one in seen):
            raise ExperimentError(f"something is near on all sides: {ROOM_M} m free are needed to move")
        if all(one.told_share == 0.0 for one in seen):
            raise ExperimentError("drive obeys nobody: somebody else drives, or the emergency stop holds")
        self._wrong(motion_problems(seen))
        self.figures["moves"] = [report.move_figures(one) for one in seen]
        self._answers(seen)
        return seen

    def stops(self) -> None:
        """Let go while it moves, then engage the emergency stop while it moves, and try to move under it.

        The stop is cleared only by who saw that it holds: where it does not, it stays engaged.
        """
        hand = self._hand
        hand.move(STOP_MPS, 0.0, 0.0, STOP_DRIVE_S)
        let_go_s = self._stood_after_s(time.time_ns())
        hand.move(-STOP_MPS, 0.0, 0.0, STOP_DRIVE_S)
        time.sleep(moving.SETTLED_S)
        driven = threading.Thread(target=hand.move, args=(STOP_MPS, 0.0, 0.0, 2.0 * STOP_DRIVE_S))
        driven.start()
        time.sleep(STOP_DRIVE_S)
        engaged_ns = time.time_ns()
        self._estop("engage")
        estop_s = self._stood_after_s(engaged_ns)
        driven.join()
        obeyed = self._stands_under_it()
        problems = report.stop_problems(report.Stops(let_go_s, estop_s, obeyed))
        self._wrong(problems)
        if problems:
            self._say("stop", "the emergency stop stays engaged: 'topnav estop --clear --who NAME' ends it")
        else:
            self._estop("clear")
        told = ["not known: no odometry" if one is None else f"{one:.2f} s" for one in (let_go_s, estop_s)]
        self._say("stop", f"after letting go {told[0]}, after the emergency stop {told[1]}")
        self.figures |= {"stop_let_go_s": let_go_s, "stop_estop_s": estop_s, "stop_obeyed": obeyed}

    def _moved(self, move: Move) -> Seen:
        """What came of a move. One that falls short is made again: a machine that pauses is no wrong base."""
        seen = moving.make(move, self._hand, self._looker)
        self._say(*report.move_line(seen))
        if falls_short(seen) and self._has_room(move):
            seen = moving.make(move, self._hand, self._looker)
            self._say(*report.move_line(seen))
        return seen

    def _pictures(self, looked: Looked) -> None:
        if not looked.frames:
            self._wrong([f"no picture came within {LOOK_S:.0f} s"])
            return
        found, self.picture = look_at(looked.frames, looked.arrivals_s, f"frames of {self._robot}")
        for word, text in camera_lines(found):
            if word in TOLD:
                self._say(word, text)
        age_s = float(np.median(looked.ages_s))
        self._say("delay", f"pictures are {age_s:.2f} s old when they come, by their stamps")
        self._wrong([*camera_problems(found), *report.delay_problems(looked.ages_s)])
        gravity = looked.frames[-1].gravity
        if gravity is not None and gravity[2] > 0.0:
            self._wrong(["gravity points up in the picture: the camera hangs upside down"])
        kept = ("width_px", "height_px", "rate_hz", "longest_pause_s", "mount", "seam")
        figures = found.figures()
        self.figures["camera"] = {**{name: figures[name] for name in kept}, "age_s": round(age_s, 3)}

    def _distances(self) -> list[float]:
        """Medians over a while.

        Raises:
            ExperimentError: none come.
        """
        looked = self._looker.look(BOX_S)
        if not looked.ranges:
            raise ExperimentError(f"no distances came within {BOX_S} s")
        told = np.median([one.distances_m for one in looked.ranges], axis=0)
        return [float(one) for one in told]

    @cached_property
    def _hand(self) -> Hand:
        return Hand(self._bus, self._robot, self._who)

    def _has_room(self, move: Move) -> bool:
        """Whether a move touches nothing; a turn on the spot never does, for the body is round."""
        if move.turn_rad:
            return True
        free_m = distances.free_m(self._distances(), move.direction_rad)
        if free_m < ROOM_M:
            self._say("move", f"{move.name}: not made, {free_m:.2f} m free of {ROOM_M} needed")
        return free_m >= ROOM_M

    def _require_idle(self) -> None:
        try:
            state = self._bus.ask(MISSION, MissionRequest(action="status"), ASK_S, robot=self._robot).state
        except AbsentError:
            return
        if state in ("running", "paused"):
            raise ExperimentError(f"a mission of {self._robot} is {state}: cancel it first")

    def _answers(self, seen: list[Seen]) -> None:
        answers = [one.answer_s for one in seen if one.answer_s is not None]
        if answers:
            slowest_s = max(answers)
            self._say("answer", f"the wheels turn within {slowest_s:.2f} s of a wish")
            self._wrong(
                [f"the wheels turned {slowest_s:.2f} s after a wish: is the network slow, the base asleep?"]
                if slowest_s > report.ANSWER_S
                else []
            )

    def _estop(self, action: Literal["engage", "clear"]) -> None:
        request = EStopRequest(action=action, who=self._who, why="topnav robot check")
        self._bus.ask(ESTOP, request, ASK_S, robot=self._robot)

    def _stood_after_s(self, from_ns: int) -> float | None:
        """When it stood, counted from then."""
        self._looker.look(3.0 * report.STOP_S)
        return moving.stopped_after_s(self._looker.odometry, from_ns)

    def _stands_under_it(self) -> bool:
        """Whether it stays where it is though a person drives it."""
        began_ns = time.time_ns()
        told = self._hand.move(-STOP_MPS, 0.0, 0.0, STOP_DRIVE_S)
        self._looker.follow()
        rolled = any(moving.moves(one) for one in self._looker.odometry if one.stamp_ns > began_ns)
        return not rolled and not any(velocity.speed_mps for velocity in told)

    def _wrong(self, problems: list[str]) -> None:
        for one in problems:
            self._say("wrong", one)
        self.problems += problems
