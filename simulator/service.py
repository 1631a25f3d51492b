"""Simulator loop: in lockstep one frame per command, else the wall clock leads."""

import logging
import threading
import time
from collections import deque
from pathlib import Path

from shared.bus import Bus
from shared.estop.sides import RobotEStop
from shared.messages.drive import Command
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Truth
from shared.sole_robot import SoleRobot
from shared.topics import COMMAND, FRAME, RANGES, SIMULATION, TRUTH
from simulator.experimenter import Experimenter, RequestError
from simulator.outbox import MessageMaker
from simulator.service_settings import SimulatorSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

log = logging.getLogger(__name__)

REAL_TIME_STEP_S = 0.02
"""Longest wait between two steps in real time; chosen: two timesteps of the physics."""
CATCH_UP_S = 0.5
"""Time lost beyond this (a suspended process) is dropped, not driven through; chosen: a command's ttl."""
MOST_AGE_S = 3.0
"""A frame becomes a command within this: what drive allows for deciding, 2 s and a heading's life of 0.5 s,
and a little more. The answer to an older one was held up: the robot is elsewhere (decision 0019)."""


class CommandAge:
    """How old a command is, counted in the robot's own frames: no clock of another machine has a say."""

    def __init__(self) -> None:
        self._sent: deque[tuple[int, float]] = deque()

    def sent(self, seq: int, now_s: float) -> None:
        """Note when one frame went out, monotonic seconds."""
        self._sent.append((seq, now_s))

    def recent(self, seq: int, now_s: float) -> bool:
        """Whether frame `seq` went out lately. One that never went out is of a robot before a restart."""
        while len(self._sent) > 1 and now_s - self._sent[0][1] > MOST_AGE_S:
            self._sent.popleft()
        return bool(self._sent) and self._sent[0][0] <= seq <= self._sent[-1][0]


class Ports:
    """Everything the loop sends and receives."""

    def __init__(self, bus: Bus, robot: str, state_dir: Path) -> None:
        self._frames = bus.publisher(FRAME, robot=robot)
        self._ranges = bus.publisher(RANGES, robot=robot)
        self._truth = bus.publisher(TRUTH, robot=robot)
        self._commands = bus.subscribe(COMMAND, robot=robot)
        self.requests = bus.requests(SIMULATION, robot=robot)
        self.stop = RobotEStop(bus, robot, state_dir)

    def send(self, *messages: Frame | Ranges | Truth) -> None:
        """Publish in the order given."""
        for message in messages:
            if isinstance(message, Frame):
                self._frames.put(message)
            elif isinstance(message, Ranges):
                self._ranges.put(message)
            else:
                self._truth.put(message)

    def newest_command(self) -> Command | None:
        """The newest command since the last call."""
        commands = self._commands.take_all()
        return commands[-1] if commands else None


class Loop:
    """What both modes share: the simulation, sequence numbers and the experimenter's requests."""

    def __init__(self, simulation: Simulation, settings: SimulatorSettings, ports: Ports) -> None:
        self.simulation, self.settings, self.ports = simulation, settings, ports
        self.maker = MessageMaker(simulation, settings)
        self._experimenter = Experimenter(simulation, self.maker, settings.seed)
        self.seq = 0
        self.stamp_ns = time.time_ns()

    def serve_requests(self) -> bool:
        """Answer waiting requests; True if the world has changed under the robot."""
        changed = False
        while (request := self.ports.requests.take()) is not None:
            try:
                reply, moved = self._experimenter.handle(request.message, self.seq, self.stamp_ns)
            except RequestError as error:
                request.refuse(str(error))
                continue
            request.reply(reply)
            changed = changed or moved
        return changed

    def sense(self) -> tuple[Ranges, Truth, Frame]:
        """Measure everything for the present sequence number."""
        self.stamp_ns = time.time_ns()
        frame = self.maker.frame(self.seq, self.stamp_ns)
        return self.maker.ranges(self.seq, self.stamp_ns), self.maker.truth(self.seq, self.stamp_ns), frame


class LockstepLoop(Loop):
    """Frame k, command k, control_period_s of physics, frame k + 1. Without a command nothing moves.

    While the emergency stop is engaged time goes on with wheels that stand, commanded or not.
    """

    def start(self) -> None:
        """Send the first frame."""
        self._send()

    def step(self, now_s: float) -> None:
        """Advance if the awaited command came; send the frame again if none came for a while."""
        command = self.ports.newest_command()
        answered = command is not None and command.seq == self.seq
        late = now_s - self._sent_s > self.settings.repeat_s
        if self.serve_requests():
            self.seq += 1
            self._send()
        elif self.ports.stop.engaged():
            if answered or late:
                self._advance(0.0, 0.0)
        elif command is not None and answered:
            self._advance(command.steer_rad, command.wheel_speed_radps)
        elif late:
            self._repeat(now_s)

    def _advance(self, steer_rad: float, wheel_speed_radps: float) -> None:
        self.simulation.command(steer_rad, wheel_speed_radps, self.settings.control_period_s)
        self.simulation.step(self.settings.control_period_s)
        self.seq += 1
        self._send()

    def _send(self) -> None:
        self._pending = self.sense()
        self._repeat(time.monotonic())

    def _repeat(self, now_s: float) -> None:
        self.ports.send(*self._pending)
        self._sent_s = now_s


class RealTimeLoop(Loop):
    """Physics follows the wall clock; frames and ranges go out at their own rates; commands expire."""

    def start(self) -> None:
        """Start the clocks; a command from before is too old to obey."""
        self.ports.newest_command()
        self._physics_s = self._frame_s = self._ranges_s = time.monotonic()
        self._age = CommandAge()

    def step(self, now_s: float) -> None:
        """Obey the newest command, let physics catch up, send what is due."""
        self.serve_requests()
        command = self.ports.newest_command()
        if self.ports.stop.engaged():
            self.simulation.stop()
        elif command is not None and self._age.recent(command.seq, now_s):
            self.simulation.command(command.steer_rad, command.wheel_speed_radps, command.ttl_ms / 1000.0)
        self._catch_up(now_s)
        if now_s >= self._ranges_s:
            self._ranges_s = max(self._ranges_s + 1.0 / self.settings.range_rate_hz, now_s)
            stamp_ns = time.time_ns()
            self.ports.send(self.maker.ranges(self.seq, stamp_ns), self.maker.truth(self.seq, stamp_ns))
        if now_s >= self._frame_s:
            self._frame_s = max(self._frame_s + 1.0 / self.settings.frame_rate_hz, now_s)
            self.seq += 1
            self.stamp_ns = time.time_ns()
            true = self.maker.truth(self.seq, self.stamp_ns)  # drawing may take half a second
            self.ports.send(true, self.maker.frame(self.seq, self.stamp_ns))
            self._age.sent(self.seq, now_s)

    def _catch_up(self, now_s: float) -> None:
        self._physics_s = max(self._physics_s, now_s - CATCH_UP_S)
        timestep_s = self.simulation.settings.timestep_s
        steps = int((now_s - self._physics_s) / timestep_s)
        if steps > 0:
            self.simulation.step(steps * timestep_s)
            self._physics_s += steps * timestep_s


def run(settings: SimulatorSettings, world: WorldFile, bus: Bus, stop: threading.Event) -> None:
    """Build the world and serve until `stop`.

    Raises:
        TakenError: another process is this robot.
    """
    sole = SoleRobot(bus, settings.robot)
    log.info("building world %s", settings.world)
    simulation = Simulation(world, settings.simulation(), settings.seed)
    ports = Ports(bus, settings.robot, settings.state_dir)
    loop = (LockstepLoop if settings.lockstep else RealTimeLoop)(simulation, settings, ports)
    sole.claim()
    bus.announce("simulator")
    log.info("world %s, %s", settings.world, "lockstep" if settings.lockstep else "real time")
    # The first picture builds the shaders, about half a second: requests can wait for that, clocks cannot.
    simulation.panorama()
    loop.start()
    while not stop.is_set():
        bus.wait(settings.repeat_s / 4 if settings.lockstep else REAL_TIME_STEP_S)
        sole.require()
        loop.step(time.monotonic())
        ports.stop.tell(time.monotonic())
