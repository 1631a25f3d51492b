"""The experimenter in the simulation: resets, hides the other robot, looks, reads the true state."""

import math
import time

from services.launcher.client.failure import ExperimentError
from shared.bus import Bus
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose, SimulationReply, SimulationRequest, Truth
from shared.queries import AbsentError
from shared.topics import SIMULATION

TIMEOUT_S = 30.0  # moving furniture builds the world and its light anew: seconds
ABSENT_S = 20.0  # a simulator that died is back within seconds; loading a world takes most of them
STILL_M = 0.001  # a tenth of what a robot at 0.1 m/s covers between two polls
STILL_POLLS = 2  # in a row: one may fall between two steps of the physics
NO_SIMULATOR = (
    "no simulator answers, and without one nobody knows where a robot truly is: a real one explores and "
    "drives by 'topnav mission start' and 'topnav goto'"
)
POLL_S = 0.1  # a third of a control period in lockstep (0.3 s)


class Experimenter:
    """Asks the simulator; counts every time it moves the robot."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot = bus, robot
        self.moves = 0

    def reset(self, seed: int) -> Truth:
        """Put the robot at the world's start and seed the noise; returns the state, stamped before that."""
        self.moves += 1
        return self._ask(SimulationRequest(action="reset", seed=seed)).truth

    def place_robot(self, pose: Pose) -> Truth:
        """Put the robot somewhere."""
        self.moves += 1
        return self._ask(SimulationRequest(action="place_robot", pose=pose)).truth

    def place_hider(self, pose: Pose) -> Frame:
        """Put the hidden robot somewhere; returns the picture it takes there."""
        return _picture(self._ask(SimulationRequest(action="place_hider", pose=pose)), "place_hider")

    def remove_hider(self) -> None:
        """Take the hidden robot away."""
        self._ask(SimulationRequest(action="remove_hider"))

    def set_item(self, name: str, present: bool | None = None, pose: Pose | None = None) -> Truth:
        """Take a piece of furniture away, put it back, or move it."""
        request = SimulationRequest(action="set_item", item=name, present=present, pose=pose)
        return self._ask(request).truth

    def place_obstacle(self, kind: str, pose: Pose, name: str | None = None) -> Truth:
        """Add furniture that the world file does not have; `set_item` takes it away again by its name."""
        request = SimulationRequest(action="place_obstacle", kind=kind, pose=pose, item=name)
        return self._ask(request).truth

    def set_light(self, illumination: float) -> Truth:
        """Let it become another time of day, from noon (0) to lamps only (1)."""
        return self._ask(SimulationRequest(action="set_light", illumination=illumination)).truth

    def look(self, pose: Pose) -> Frame:
        """Take a picture from any pose."""
        return _picture(self._ask(SimulationRequest(action="look", pose=pose)), "look")

    def truth(self) -> Truth:
        """The true state now."""
        return self._ask(SimulationRequest(action="truth")).truth

    def settled_truth(self, after_seq: int = -1, timeout_s: float = 10.0) -> Truth:
        """The true state once frame `after_seq` is answered and the robot stands still."""
        deadline_s = time.monotonic() + timeout_s
        last, still = self.truth(), 0
        while still < STILL_POLLS and time.monotonic() < deadline_s:
            time.sleep(POLL_S)
            now = self.truth()
            moved_m = math.hypot(now.pose.x_m - last.pose.x_m, now.pose.y_m - last.pose.y_m)
            still = still + 1 if moved_m < STILL_M and now.seq > after_seq else 0
            last = now
        return last

    def _ask(self, request: SimulationRequest) -> SimulationReply:
        """Ask; a simulator that restarts, or that this session has not met yet, is waited for."""
        deadline_s = time.monotonic() + ABSENT_S
        while True:
            try:
                return self._bus.ask(SIMULATION, request, TIMEOUT_S, robot=self._robot)
            except AbsentError as error:
                if time.monotonic() > deadline_s:
                    raise ExperimentError(NO_SIMULATOR) from error
            time.sleep(POLL_S)


def _picture(reply: SimulationReply, action: str) -> Frame:
    if reply.frame is None:
        raise ExperimentError(f"the simulator answered {action} without a picture")
    return reply.frame
