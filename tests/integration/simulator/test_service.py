"""The simulator process over a real bus: lockstep, repetition, requests, real time."""

import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from typer.testing import CliRunner

from services.launcher.commands.assets.world import app
from shared.bus import Bus, open_bus, wait_until
from shared.messages.drive import Velocity
from shared.messages.estop import EStopState
from shared.messages.simulation import Pose, SimulationRequest
from shared.queries import RefusedError
from shared.topics import ESTOP_STATE, FRAME, RANGES, ROBOT_ESTOP_STATE, SIMULATION, TRUTH, VELOCITY

pytestmark = [pytest.mark.render, pytest.mark.usefixtures("patient_sessions")]
START_S, SOON_S = 90.0, 60.0


@pytest.fixture(autouse=True)
def _asked_again(monkeypatch):
    """A process that stands still for longer than the lease is absent for a while, and then answers."""
    monkeypatch.setattr("shared.queries.MEETING_S", SOON_S)


class Peer:
    """The other side: keeps the newest frame and ranges, and all truths."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self.bus, self.robot = bus, robot
        self._in = [bus.subscribe(topic, robot=robot) for topic in (FRAME, RANGES, TRUTH)]
        self._commands = bus.publisher(VELOCITY, robot=robot)
        self._estop_states = bus.publisher(ESTOP_STATE, robot=robot)
        self.robot_estop = bus.subscribe(ROBOT_ESTOP_STATE, robot=robot)
        self.frame = self.ranges = self.truth = None
        self.frames = 0
        self.truths = []

    def poll(self):
        for name, inbox in zip(("frame", "ranges", "truth"), self._in, strict=True):
            for message in inbox.take_all():
                setattr(self, name, message)
                self.frames += name == "frame"
                self.truths += [message] if name == "truth" else []

    def wait_for(self, condition, timeout_s=SOON_S):
        def check():
            self.poll()
            return condition()

        assert wait_until(check, timeout_s)

    def complete(self, seq):
        """Everything of frame `seq` (or later) is here."""
        return all(m is not None and m.seq >= seq for m in (self.frame, self.ranges, self.truth))

    def command(self, seq, forward_mps=0.32, left_mps=0.0, ttl_ms=500):
        self._commands.put(
            Velocity(seq=seq, robot=self.robot, forward_mps=forward_mps, left_mps=left_mps, ttl_ms=ttl_ms)
        )

    def answer(self, seq):
        """In lockstep: command until what follows is here; any single message may be lost."""
        self.wait_for(lambda: self.complete(seq + 1) or self.command(seq))

    def drive_says(self, seq, engaged, who=""):
        self._estop_states.put(EStopState(robot="r1", seq=seq, engaged=engaged, who=who))

    def ask(self, **request):
        return self.bus.ask(SIMULATION, SimulationRequest(**request), timeout_s=SOON_S, robot=self.robot)


@pytest.fixture
def start(router_endpoint, room_file, tmp_path):
    """Start a simulator process; returns the peer once it answers."""
    processes = []
    buses = []

    def launch(lockstep, robot="r1", **settings):
        environment = {
            **os.environ,
            "TOPNAV_ROBOT": robot,
            "TOPNAV_ENDPOINT": router_endpoint,
            "SIMULATOR_WORLD": room_file,
            "SIMULATOR_WIDTH_PX": "256",
            "SIMULATOR_LOCKSTEP": str(lockstep).lower(),
            "SIMULATOR_REPEAT_S": "0.3",
            "SIMULATOR_CACHE_DIR": str(tmp_path / "cache"),
            "SIMULATOR_STATE_DIR": str(tmp_path / f"state-{robot}"),
            **settings,
        }
        manager = open_bus(router_endpoint)
        peer = Peer(manager.__enter__(), robot)
        buses.append(manager)
        peer.process = subprocess.Popen([sys.executable, "-m", "simulator"], env=environment)
        processes.append(peer.process)
        peer.wait_for(lambda: peer.frame is not None, START_S)
        return peer

    yield launch
    for manager in buses:
        manager.__exit__(None, None, None)
    for process in processes:
        if process.poll() == -signal.SIGKILL:
            continue
        process.terminate()
        assert process.wait(timeout=SOON_S) == 0


def test_lockstep_advances_one_period_per_command_and_waits_without_one(start):
    peer = start(lockstep=True)
    peer.wait_for(lambda: peer.complete(0))
    assert peer.frame.lockstep
    assert peer.frame.gravity is None
    first, seen = peer.frame, peer.frames
    peer.wait_for(lambda: peer.frames >= seen + 2)  # repeated: same frame, same bytes
    assert (peer.frame.seq, peer.frame.stamp_ns, peer.frame.data) == (first.seq, first.stamp_ns, first.data)
    assert peer.truth.sim_time_s == 0.0

    x_m = peer.truth.pose.x_m
    for seq in range(4):
        peer.answer(seq)
    assert peer.frame.seq == peer.ranges.seq == peer.truth.seq == 4
    assert peer.truth.sim_time_s == pytest.approx(1.2)
    assert 0.2 < peer.truth.pose.x_m - x_m < 0.4

    seen = peer.frames
    peer.wait_for(lambda: peer.frames >= seen + 2 or peer.command(2))  # an answer to an old frame
    assert peer.truth.seq == 4


def test_late_frames_show_and_stamp_an_earlier_moment_than_the_distances(start):
    peer = start(lockstep=True, SIMULATOR_DISTURBANCE="latency=0.75")  # 450 ms: one and a half periods
    peer.wait_for(lambda: peer.complete(0))
    first, pictures = peer.frame.stamp_ns, [peer.frame.data]
    for seq in range(4):
        peer.answer(seq)
        peer.wait_for(lambda seq=seq: peer.complete(seq + 1))
        pictures.append(peer.frame.data)
        late_ms = (peer.ranges.stamp_ns - peer.frame.stamp_ns) // 1_000_000
        assert late_ms == (300, 450, 450, 450)[seq]
    assert pictures[1] == pictures[0]
    assert pictures[3] != pictures[2] != pictures[1]
    peer.ask(action="reset", pose=Pose(x_m=3.0, y_m=2.0, yaw_rad=1.0))
    peer.wait_for(lambda: peer.complete(5))
    assert peer.frame.stamp_ns == peer.ranges.stamp_ns > first  # nothing of before is under way


def test_for_a_lost_frame_another_period_passes(start):
    peer = start(lockstep=True, SIMULATOR_DISTURBANCE="drops=1", SIMULATOR_SEED="2")
    peer.wait_for(lambda: peer.complete(0))
    while peer.frame.seq < 12:
        peer.answer(peer.frame.seq)
    assert peer.frame.seq == peer.truth.seq
    assert peer.truth.sim_time_s == pytest.approx(0.3 * peer.frame.seq)


def test_frames_of_a_robot_with_an_imu_say_where_down_is(start):
    peer = start(lockstep=True, SIMULATOR_IMU="true", SIMULATOR_DISTURBANCE="mount=1")
    peer.wait_for(lambda: peer.complete(0))
    seen = peer.frame, peer.ask(action="look").frame
    for frame in seen:
        assert math.degrees(math.acos(-frame.gravity[2])) == pytest.approx(10.0, abs=1.5)


def test_requests_place_robots_return_pictures_and_keep_counting(start):
    peer = start(lockstep=True)
    peer.wait_for(lambda: peer.complete(0))
    reply = peer.ask(action="place_hider", pose=Pose(x_m=1.0, y_m=1.0, yaw_rad=0.5))
    assert (reply.frame.width_px, reply.frame.height_px) == (256, 128)
    assert reply.truth.hider.x_m == 1.0
    reply = peer.ask(action="reset", seed=4, pose=Pose(x_m=3.0, y_m=2.0, yaw_rad=1.0))
    assert reply.truth.pose.x_m == pytest.approx(3.0)
    assert reply.truth.collisions == 0
    peer.wait_for(lambda: peer.complete(2))
    assert peer.truth.pose.yaw_rad == pytest.approx(1.0, abs=1e-3)
    assert peer.ask(action="look").frame is not None
    with pytest.raises(RefusedError, match=r"must lie inside a room of small"):
        peer.ask(action="place_robot", pose=Pose(x_m=9.0, y_m=2.0, yaw_rad=0.0))
    with pytest.raises(RefusedError, match="needs a pose"):
        peer.ask(action="place_hider")


def test_furniture_is_moved_from_the_shell(start, router_endpoint):
    def shell(*words):
        return CliRunner().invoke(app, ["move", *words, "--endpoint", router_endpoint])

    peer = start(lockstep=True)
    peer.wait_for(lambda: peer.complete(0))
    pictures = [peer.ask(action="look").frame.data]
    for words in (["--gone"], ["--to", "1.0", "2.0", "45"], ["--back"]):
        done = shell("rug-1", *words)
        assert done.exit_code == 0, done.output
        pictures.append(peer.ask(action="look").frame.data)
    assert pictures[3] == pictures[0]
    assert len(set(pictures)) == 3
    assert "picture-2" in str(shell("rug-7", "--gone").exception)
    assert shell("rug-1", "--gone", "--back").exit_code == 2


def test_real_time_runs_by_itself_and_stops_when_commands_end(start):
    peer = start(lockstep=False)
    assert not peer.frame.lockstep
    peer.wait_for(lambda: peer.truth is not None and peer.frame.seq > 3)
    turn = {"forward_mps": 0.22, "left_mps": 0.34, "ttl_ms": 300}
    peer.wait_for(lambda: peer.truth.speed_mps > 0.1 or peer.command(peer.frame.seq, **turn))
    # No command after this. Time is that of the robot: of what it stood still as a process, it drives little.
    moving_s = peer.truth.sim_time_s

    def still_s():
        return [t.sim_time_s for t in peer.truths if t.sim_time_s > moving_s and t.speed_mps < 0.01]

    peer.wait_for(still_s)
    assert still_s()[0] - moving_s < 3.0


def test_in_real_time_every_frame_has_a_true_state_of_its_own_moment(start):
    peer = start(lockstep=False)
    peer.wait_for(lambda: peer.truth is not None and peer.frame.seq > 3)
    moment = peer.frame.seq, peer.frame.stamp_ns
    peer.wait_for(lambda: moment in [(t.seq, t.stamp_ns) for t in peer.truths])


def test_a_killed_simulator_finds_its_textures_and_light_again(start, tmp_path):
    def kept():
        return {path.name: path.stat().st_ino for path in (tmp_path / "cache").iterdir()}

    first = start(lockstep=True)
    first.process.kill()
    first.process.wait()
    before = kept()
    second = start(lockstep=True)
    assert len(before) > 5
    assert kept() == before
    assert second.frame.data == first.frame.data


def says(peer, engaged):
    """Whether the robot has just said that its emergency stop is engaged, or not; it repeats its state."""
    news = peer.robot_estop.take_all()
    return bool(news) and news[-1].engaged is engaged


def test_while_the_emergency_stop_is_engaged_lockstep_goes_on_and_commands_move_nothing(start):
    peer = start(lockstep=True)
    peer.wait_for(lambda: peer.complete(0))
    peer.wait_for(lambda: says(peer, engaged=True) or peer.drive_says(1, engaged=True))
    before = peer.truth
    peer.wait_for(lambda: peer.complete(before.seq + 2))  # nobody commands: time goes on all the same
    for _ in range(4):
        peer.answer(peer.frame.seq)
    assert peer.truth.sim_time_s >= 6 * 0.3 - 1e-6
    assert peer.truth.pose.x_m == pytest.approx(before.pose.x_m, abs=1e-3)
    peer.wait_for(lambda: says(peer, engaged=False) or peer.drive_says(2, engaged=False, who="anna"))
    x_m = peer.truth.pose.x_m
    peer.wait_for(lambda: peer.truth.pose.x_m > x_m + 0.2 or peer.command(peer.frame.seq))


def test_a_robot_that_was_killed_still_stands_and_ignores_commands(start):
    first = start(lockstep=False)
    first.wait_for(lambda: first.complete(0))
    first.wait_for(lambda: says(first, engaged=True) or first.drive_says(1, engaged=True, who="anna"))
    first.process.kill()
    first.process.wait()
    second = start(lockstep=False)
    second.wait_for(lambda: second.complete(0))
    second.wait_for(lambda: says(second, engaged=True))

    def insist():
        second.command(second.frame.seq)
        return second.truth.sim_time_s > 1.0

    second.wait_for(insist)
    assert second.truth.speed_mps < 0.01
    assert second.truth.pose.x_m == pytest.approx(first.truth.pose.x_m, abs=0.01)


def test_in_real_time_a_command_for_a_frame_of_long_ago_moves_nothing(start):
    peer = start(lockstep=False)
    peer.wait_for(lambda: peer.truth is not None and peer.truth.sim_time_s > 4.5)
    for seq in (1, peer.frame.seq + 1000):  # held up on its way; from before the robot was restarted
        until_s = peer.truth.sim_time_s + 0.5

        def insist():
            peer.command(seq)  # noqa: B023
            return peer.truth.sim_time_s > until_s  # noqa: B023

        peer.wait_for(insist)
        assert peer.truth.speed_mps < 0.01
    peer.wait_for(lambda: (peer.command(peer.frame.seq), peer.truth.speed_mps > 0.1)[1])


def test_robots_of_one_place_see_and_feel_each_other(start):
    """r2 is put before r1, which stands and looks along x; when its simulator is gone, so is it."""
    first = start(lockstep=False, SIMULATOR_COMPANY="r2")
    first.wait_for(lambda: first.complete(1))
    alone, free_m = first.frame, first.ranges.distances_m[0]
    second = start(lockstep=False, robot="r2", SIMULATOR_COMPANY="r1")
    second.ask(action="place_robot", pose=Pose(x_m=3.2, y_m=2.0, yaw_rad=math.pi))
    first.wait_for(lambda: first.ranges.distances_m[0] < free_m - 0.5)
    second.wait_for(lambda: second.ranges.distances_m[0] < 1.1)
    seen = first.frame.seq
    first.wait_for(lambda: first.frame.seq > seen + 1)
    assert differing(alone, first.frame) > 100
    second.process.kill()
    first.wait_for(lambda: first.ranges.distances_m[0] > free_m - 0.1)
    seen = first.frame.seq
    first.wait_for(lambda: first.frame.seq > seen + 1)
    assert differing(alone, first.frame) < 20


def test_in_lockstep_none_runs_away_from_one_that_thinks_for_long(start):
    """r2 answers once a second, r1 at once."""
    first = start(lockstep=True, SIMULATOR_COMPANY="r2")
    second = start(lockstep=True, robot="r2", SIMULATOR_COMPANY="r1")
    begun, ahead = first.truth.seq, []
    for seq in range(5):
        thought_s = time.monotonic() + 1.0
        first.wait_for(lambda: (first.command(first.truth.seq), time.monotonic() > thought_s)[1])  # noqa: B023
        ahead.append(first.truth.seq - begun - seq)
        second.answer(seq)
    assert max(ahead) <= 2
    assert first.truth.seq - begun >= 4


def differing(one, other):
    """Pixels that differ clearly between two frames."""
    apart = np.frombuffer(one.data, np.uint8).astype(int) - np.frombuffer(other.data, np.uint8)
    return int((np.abs(apart) > 40).sum())
