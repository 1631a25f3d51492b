"""What the robot senses: payloads of its topics to messages of topnav; what is wrong is named, not used."""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from services.ros.conversions.body import battery_of, imu_of, odometry_of
from services.ros.conversions.header import ConversionError, check_frame, stamp_s
from services.ros.conversions.picture import panorama_of
from services.ros.conversions.robot_clock import RobotClock
from services.ros.conversions.scan import sectors_of
from services.ros.conversions.turning import TurningCheck
from services.ros.robot_file import RobotFile
from services.ros.wires.codec import Codec, CodecError
from services.ros.wires.wire import Wire
from shared.messages.base import SECTORS, Message
from shared.messages.body import Odometry
from shared.messages.sensors import Frame, Ranges

SCAN, IMU = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu"
ODOMETRY, BATTERY = "nav_msgs/msg/Odometry", "sensor_msgs/msg/BatteryState"
ANGLES_RAD = tuple(sector * math.tau / SECTORS for sector in range(SECTORS))
NS = 1_000_000_000
TROUBLE_S = 1.0
"""Nothing moves for so long after a picture or a scan that cannot be used; chosen: some of each are good
again."""
SILENT_S = 2.0
"""A topic that nothing comes on for so long is named; chosen: ten readings of a slow camera."""
SAME_CLOCK_S = 1.0
"""Topics whose clocks are nearer than this are stamped by one."""

Count = Callable[[str, str], None]


class ClockJumpError(ConversionError):
    """The robot's clock was set while topnav listened."""


@dataclass
class Source:
    """One topic that is heard: its newest payload, and what is known of it."""

    topic: str
    kind: str
    frame: str
    convert: Callable[[Any, int, float], Message]
    clock: RobotClock
    payload: bytes | None = None
    came_s: float = 0.0
    heard_s: float = 0.0
    trouble_s: float = -math.inf
    trouble: str = ""


class Sensing:
    """All topics of a robot's file.

    Args:
        file: the robot.
        codec: of its ROS.
        robot: name on the bus.
        count: counts a fault by kind, with a line that names it.
        now_s, wall_ns: this moment by the monotonic clock and by the calendar.
    """

    def __init__(
        self, file: RobotFile, codec: Codec, robot: str, count: Count, now_s: float, wall_ns: int
    ) -> None:
        self._file, self._codec, self._robot, self._count = file, codec, robot, count
        self._wall_ns = wall_ns - round(now_s * NS)
        self._lock = threading.Lock()
        self._turning, self._blind = TurningCheck(), tuple[int, ...]()
        self._pose: Odometry | None = None
        self.seq = 0
        self._sources = [Source(*row, RobotClock(), heard_s=now_s) for row in self._rows()]
        self._ignore_until_s = -math.inf

    def _rows(self) -> list[tuple[str, str, str, Callable[[Any, int, float], Message]]]:
        file = self._file
        rows: list[tuple[str, str, str, Callable[[Any, int, float], Message]]] = []
        if file.odometry is not None:  # first: a scan is compared with it
            rows.append((file.odometry.topic, ODOMETRY, file.odometry.frame, self._odometry))
        if file.camera is not None:
            rows.append((file.camera.topic, file.camera.type, file.camera.frame, self._frame))
        rows.append((file.scan.topic, SCAN, file.scan.frame, self._ranges))
        if file.imu is not None:
            rows.append((file.imu.topic, IMU, file.imu.frame, self._imu))
        if file.battery is not None:
            rows.append((file.battery.topic, BATTERY, file.battery.frame, self._battery))
        return rows

    def subscribe(self, wire: Wire, wake: threading.Event) -> None:
        """Hear all topics; `wake` is set when something came."""
        for source in self._sources:

            def store(payload: bytes, came_s: float, source: Source = source) -> None:
                with self._lock:
                    source.payload, source.came_s = payload, came_s
                wake.set()

            wire.subscribe(source.topic, source.kind, store)

    def take(self, now_s: float) -> list[Message]:
        """Messages of what came since the last call."""
        messages = []
        for source in self._sources:
            with self._lock:
                payload, came_s = source.payload, source.came_s
                source.payload = None
            if payload is not None and now_s >= self._ignore_until_s:
                message = self._read(source, payload, came_s, now_s)
                messages += [] if message is None else [message]
        return messages

    def ignore(self, until_s: float) -> None:
        """Throw away what comes until then: it waited while this process stood still."""
        self._ignore_until_s = until_s

    def problem(self, now_s: float) -> str:
        """Why the robot must stand now; "" if it need not."""
        for source in self._sources:
            needed = source.kind == SCAN or source.convert == self._frame
            if needed and now_s - source.trouble_s < TROUBLE_S:
                return source.trouble
        if self._turning.mirrored:
            scan, odometry = self._file.scan.topic, self._file.odometry
            return (
                f"{scan}: scans turn against {odometry.topic if odometry else 'nothing'}: the scanner is "
                "mirrored (scan.upside_down in the robot's file), or the odometry's yaw has the wrong sign"
            )
        return ""

    def tell_silence(self, wire: Wire, now_s: float) -> None:
        """Name the topics that nothing comes on, and why where that can be known."""
        for source in self._sources:
            if now_s - source.heard_s > SILENT_S:
                source.heard_s = now_s
                self._count(f"silent {source.topic}", silence(source.topic, source.kind, wire))

    def robot_time_s(self, now_s: float) -> float | None:
        """Now by the robot's clock; None while it is not known."""
        offsets = [s.clock.offset_s for s in self._sources if s.clock.offset_s is not None]
        return now_s + max(offsets) if offsets else None

    def _read(self, source: Source, payload: bytes, came_s: float, now_s: float) -> Message | None:
        source.heard_s = now_s
        try:
            message = self._codec.decode(source.kind, payload)
            check_frame(message, source.frame)
            stamp = stamp_s(message)
            at_s = came_s if stamp is None else self._judged(source, stamp, came_s)
            return source.convert(message, self._wall_ns + round(at_s * NS), now_s)
        except (CodecError, ConversionError) as error:
            source.trouble, source.trouble_s = f"{source.topic}: {error}", now_s
            jumped = isinstance(error, ClockJumpError)  # happens once: no other line may hide it
            self._count(f"{'clock of' if jumped else 'bad'} {source.topic}", source.trouble)
            return None

    def _judged(self, source: Source, stamp: float, came_s: float) -> float:
        """When it was measured by our monotonic clock.

        Raises:
            ConversionError: it was held up, or the robot's clock jumped.
        """
        judged = source.clock.judge(stamp, came_s)
        if judged.verdict == "late":
            raise ConversionError(f"held up for {-judged.off_s:.1f} s on its way")
        if judged.verdict == "jumped":
            raise ClockJumpError(f"the robot's clock jumped by {judged.off_s:+.1f} s")
        own_s = source.clock.offset_s or 0.0
        offsets = [s.clock.offset_s for s in self._sources if s.clock.offset_s is not None]
        return stamp - max(offset for offset in offsets if abs(offset - own_s) < SAME_CLOCK_S)

    def _frame(self, message: Any, stamp_ns: int, _now_s: float) -> Frame:
        assert self._file.camera is not None
        panorama = panorama_of(message, self._file.camera.type, self._file.camera.ahead_share)
        self.seq += 1
        return Frame(
            seq=self.seq, stamp_ns=stamp_ns, robot=self._robot, encoding=panorama.encoding,
            width_px=panorama.width_px, height_px=panorama.height_px, data=panorama.data,
        )  # fmt: skip

    def _ranges(self, message: Any, stamp_ns: int, _now_s: float) -> Ranges:
        scan = self._file.scan
        most_m = min(scan.max_m, float(message.range_max))
        sectors = sectors_of(message, scan.mount, scan.own_radius_m, most_m, scan.nothing)
        if sectors.blind != self._blind:
            self._blind = sectors.blind
            named = ", ".join(f"{30 * sector}" for sector in sectors.blind) or "none"
            self._count("blind", f"{scan.topic}: blind at (degrees): {named}; taken for occupied")
        if self._pose is not None:
            self._turning.see(sectors.profile_m, self._pose.x_m, self._pose.y_m, self._pose.yaw_rad)
        return Ranges(
            seq=self.seq, stamp_ns=stamp_ns, robot=self._robot, angles_rad=ANGLES_RAD,
            distances_m=sectors.distances_m, max_range_m=most_m,
        )  # fmt: skip

    def _odometry(self, message: Any, stamp_ns: int, _now_s: float) -> Odometry:
        self._pose = odometry_of(message, self._robot, self.seq, stamp_ns)
        return self._pose

    def _imu(self, message: Any, stamp_ns: int, _now_s: float) -> Message:
        return imu_of(message, self._robot, self.seq, stamp_ns)

    def _battery(self, message: Any, stamp_ns: int, _now_s: float) -> Message:
        return battery_of(message, self._robot, self.seq, stamp_ns)


def silence(topic: str, kind: str, wire: Wire) -> str:
    """Why nothing comes on a topic, from who publishes it."""
    there = wire.publishers(topic)
    if not there:
        return f"{topic}: nobody publishes it"
    if all(endpoint.kind != kind for endpoint in there):
        came = ", ".join(sorted(f"{endpoint.node} as {endpoint.kind}" for endpoint in there))
        return f"{topic}: {kind} expected, but it is published by {came}"[:400]
    return f"{topic}: {there[0].node} publishes it, but nothing comes"
