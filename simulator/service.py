"""Simulator loop: in lockstep one frame per velocity, else the wall clock leads."""

import logging
import threading
import time
from collections import deque
from typing import Any

from shared.bus import Bus, Publisher
from shared.estop.sides import RobotEStop
from shared.messages.base import Message
from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Truth
from shared.sole_robot import SoleRobot
from shared.topics import FRAME, ODOMETRY, RANGES, SIMULATION, TRUTH, VELOCITY
from simulator.disturbances.transit import Transit
from simulator.experimenter import Experimenter, RequestError
from simulator.neighbours import Neighbours
from simulator.outbox import MessageMaker
from simulator.pace import Pace
from simulator.service_settings import SimulatorSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

log = logging.getLogger(__name__)

REAL_TIME_STEP_S = 0.02
"""Longest wait between two steps in real time; chosen: two timesteps of the physics."""
CATCH_UP_S = 0.5
"""Time lost beyond this (a suspended process) is dropped, not driven through; chosen: a command's ttl."""
MOST_AGE_S = 3.0
"""A frame becomes a velocity within this: what drive allows for deciding, 2 s and a heading's life of 0.5 s,
and a little more. The answer to an older one was held up: the robot is elsewhere (decision 0019)."""
CHANGE_NS = 1_000_000
"""Time that passes in lockstep while the experimenter changes something: a later frame has a later stamp."""


class RecentFrames:
    """Which frames are recent, counted in the robot's own frames: no clock of another machine has a say."""

    def __init__(self) -> None:
        self._sent: deque[tuple[int, float]] = deque()

    def sent(self, seq: int, now_s: float) -> None:
        """Note when one frame went out, monotonic seconds."""
        self._sent.append((seq, now_s))

    def has(self, seq: int, now_s: float) -> bool:
        """Whether frame `seq` went out lately. One that never went out is of a robot before a restart."""
        while len(self._sent) > 1 and now_s - self._sent[0][1] > MOST_AGE_S:
            self._sent.popleft()
        return bool(self._sent) and self._sent[0][0] <= seq <= self._sent[-1][0]


class Ports:
    """Everything the loop sends and receives."""

    def __init__(self, bus: Bus, settings: SimulatorSettings, world: str) -> None:
        robot = settings.robot
        self._out: dict[type[Message], Publisher[Any]] = {
            Frame: bus.publisher(FRAME, robot=robot),
            Ranges: bus.publisher(RANGES, robot=robot),
            Truth: bus.publisher(TRUTH, robot=robot),
            Odometry: bus.publisher(ODOMETRY, robot=robot),
        }
        self._velocities = bus.subscribe(VELOCITY, robot=robot)
        self.requests = bus.requests(SIMULATION, robot=robot)
        self.stop = RobotEStop(bus, robot, settings.state_dir)
        self.neighbours = Neighbours(bus, settings.company, world)

    def send(self, *messages: Message) -> None:
        """Publish in the order given."""
        for message in messages:
            self._out[type(message)].put(message)

    def newest_velocity(self) -> Velocity | None:
        """The newest velocity since the last call."""
        velocities = self._velocities.take_all()
        return velocities[-1] if velocities else None


class Loop:
    """What both modes share: the simulation, sequence numbers and the experimenter's requests."""

    def __init__(self, simulation: Simulation, settings: SimulatorSettings, ports: Ports) -> None:
        self.simulation, self.settings, self.ports = simulation, settings, ports
        self.maker = MessageMaker(simulation, settings)
        self._experimenter = Experimenter(simulation, self.maker, settings.seed)
        levels = settings.disturbance
        self.pace = Pace()
        self.transit: Transit[Frame] = Transit(levels.latency, levels.drops, settings.seed)
        self.seq = 0
        self.stamp_ns = time.time_ns()

    def hear_neighbours(self, now_s: float) -> None:
        """Learn where the other robots are; `now_s` is monotonic."""
        for name, truth in self.ports.neighbours.news(now_s):
            if truth is None:
                self.pace.gone(name)
                self.simulation.tell_company(name, None)
                continue
            self.pace.heard(name, truth.stamp_ns, now_s)
            pose = truth.pose
            self.simulation.tell_company(name, (pose.x_m, pose.y_m, pose.yaw_rad))

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

    def sense_body(self) -> list[Message]:
        """What the robot measures beside the picture: odometry if it has any, distances; and the truth."""
        odometry = [self.maker.odometry(self.seq, self.stamp_ns)] if self.settings.odometry else []
        ranges = self.maker.ranges(self.seq, self.stamp_ns)
        return [*odometry, ranges, self.maker.truth(self.seq, self.stamp_ns)]


class LockstepLoop(Loop):
    """Frame k, velocity k, control_period_s of physics, frame k + 1. Without a velocity nothing moves.

    While the emergency stop is engaged time goes on with a robot that stands, commanded or not. Stamps are of
    the robot's own time, which begins at the wall clock's and goes on with the physics. A frame that comes
    late shows an earlier moment and says so by its stamp; for one that is lost another period passes. Robots
    of one place wait for one another (`Pace`).
    """

    def start(self) -> None:
        """Send the first frame."""
        self._answer: Velocity | None = None
        self._begin()

    def step(self, now_s: float) -> None:
        """Advance if the awaited velocity came; send the frame again if none came for a while."""
        self.hear_neighbours(now_s)
        velocity = self._answer_to_frame()
        waits = self.pace.is_ahead(now_s)
        late = now_s - self._sent_s > self.settings.repeat_s
        if self.serve_requests():
            self.seq += 1
            self.stamp_ns += CHANGE_NS
            self._begin()
        elif self.ports.stop.engaged():
            if late or (velocity is not None and not waits):
                self._advance(None)
        elif velocity is not None and not waits:
            self._advance(velocity)
        elif late:
            self._repeat(now_s, Truth if waits else Message)

    def _answer_to_frame(self) -> Velocity | None:
        """The velocity for the last frame, kept while the robot waits for others."""
        newest = self.ports.newest_velocity()
        if newest is not None and newest.seq == self.seq:
            self._answer = newest
        return self._answer if self._answer is not None and self._answer.seq == self.seq else None

    def _advance(self, velocity: Velocity | None) -> None:
        period_s = self.settings.control_period_s
        if velocity is None:
            self.simulation.stop()
        else:
            self.simulation.command(
                velocity.forward_mps,
                velocity.left_mps,
                velocity.turn_radps,
                max(period_s, velocity.ttl_ms / 1000.0),
            )
        self._pass(period_s)
        while self.transit.loses(self.seq):
            self._pass(period_s)
        self._send()

    def _pass(self, period_s: float) -> None:
        """Let time pass; on the way the frame is exposed that arrives at the end of a later period."""
        late_ns = self.transit.delay_ns % round(1e9 * period_s)
        self._drive_on(round(1e9 * period_s) - late_ns)
        self._expose()
        self._drive_on(late_ns)
        self.seq += 1
        self.pace.passed(period_s)

    def _drive_on(self, duration_ns: int) -> None:
        if duration_ns > 0:
            self.simulation.step(1e-9 * duration_ns)
            self.stamp_ns += duration_ns

    def _begin(self) -> None:
        """The first frame, or the first of a world that has changed: what was under way is void."""
        self.transit.clear()
        self._frame = self._expose()
        self._send()

    def _expose(self) -> Frame:
        frame = self.maker.frame(self.seq, self.stamp_ns)
        self.transit.expose(frame, self.stamp_ns)
        return frame

    def _send(self) -> None:
        for frame in self.transit.arrived(self.stamp_ns):
            self._frame = frame
        self._pending = [*self.sense_body(), self._frame.model_copy(update={"seq": self.seq})]
        self._repeat(time.monotonic())

    def _repeat(self, now_s: float, kind: type[Message] = Message) -> None:
        self.ports.send(*(message for message in self._pending if isinstance(message, kind)))
        self._sent_s = now_s


class RealTimeLoop(Loop):
    """Physics follows the wall clock; frames and ranges go out at their own rates; velocities expire."""

    def start(self) -> None:
        """Start the clocks; a velocity from before is too old to obey."""
        self.ports.newest_velocity()
        self._physics_s = self._frame_s = self._ranges_s = time.monotonic()
        self._recent = RecentFrames()

    def step(self, now_s: float) -> None:
        """Obey the newest velocity, let physics catch up, send what is due."""
        self.serve_requests()
        self.hear_neighbours(now_s)
        velocity = self.ports.newest_velocity()
        if self.ports.stop.engaged():
            self.simulation.stop()
        elif velocity is not None and self._recent.has(velocity.seq, now_s):
            self.simulation.command(
                velocity.forward_mps, velocity.left_mps, velocity.turn_radps, velocity.ttl_ms / 1000.0
            )
        self._catch_up(now_s)
        if now_s >= self._ranges_s:
            self._ranges_s = max(self._ranges_s + 1.0 / self.settings.range_rate_hz, now_s)
            self.stamp_ns = time.time_ns()
            self.ports.send(*self.sense_body())
        if now_s >= self._frame_s:
            self._frame_s = max(self._frame_s + 1.0 / self.settings.frame_rate_hz, now_s)
            self.seq += 1
            self.stamp_ns = time.time_ns()
            self.ports.send(self.maker.truth(self.seq, self.stamp_ns))  # drawing may take half a second
            self._recent.sent(self.seq, now_s)
            if not self.transit.loses(self.seq):
                self.transit.expose(self.maker.frame(self.seq, self.stamp_ns), round(1e9 * now_s))
        self.ports.send(*self.transit.arrived(round(1e9 * now_s)))

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
    ports = Ports(bus, settings, simulation.world.name)
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
