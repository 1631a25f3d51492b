"""Camera loop: the newest picture of the camera goes out as a frame, at most so many a second."""

import logging
import math
import threading
import time

from services.camera.frames import FrameMaker, FrameSettings
from services.camera.mount.calibration_file import FisheyeCalibration, load_calibration
from services.camera.reader import Reader
from services.camera.settings import CameraSettings
from shared.bus import Bus
from shared.jpeg import BadPictureError
from shared.messages.camera import CameraState
from shared.messages.sensors import Frame
from shared.topics import CAMERA_STATE, FEATURES, FRAME

log = logging.getLogger(__name__)

STEP_S = 0.05
"""Between two steps when nothing wakes the loop; chosen: half the period of frames."""
STATE_PERIOD_S = 1.0
"""Between two reports on the camera while nothing changes; chosen. What begins or ends is said at once."""
REPEAT_S = 0.5
"""After which a frame of a stepped source that has no features yet is sent again, as the simulator does."""
JOIN_S = 1.0


class Camera:
    """One camera on the bus."""

    def __init__(self, settings: CameraSettings, bus: Bus, stop: threading.Event) -> None:
        self._settings, self._bus, camera = settings, bus, settings.camera
        self._name = camera.url.shown
        self._maker = FrameMaker(frame_settings(settings), settings.orientation, fisheye_of(settings))
        self._frames = bus.publisher(FRAME, robot=settings.robot)
        self._states = bus.publisher(CAMERA_STATE, robot=settings.robot)
        self._features = bus.subscribe(FEATURES, robot=settings.robot) if camera.stepped else None
        self.reader = Reader(
            camera.opener(stop), self._name, stop, bus.wake, self._refuse, camera.kind.live, camera.stepped
        )
        self._seq, self._due_s, self._state_s, self._told = 0, 0.0, 0.0, ""
        self._sent: Frame | None = None
        self._sent_s, self._answered, self._fault, self._fault_s = 0.0, True, "", -math.inf

    def step(self, now_s: float) -> None:
        """Send what is due."""
        if self._features is not None:
            self._step_on(now_s)
        elif now_s >= self._due_s:
            self._send_next(now_s)
        problem = self.reader.status().problem
        # A stream that breaks is open again after half a second: one report a second would miss many.
        if problem != self._told or now_s - self._state_s >= STATE_PERIOD_S:
            self._told, self._state_s = problem, now_s
            self._states.put(self._state(now_s))

    def _step_on(self, now_s: float) -> None:
        """Stepped: the next picture when the features of the last one are there."""
        assert self._features is not None
        while (features := self._features.take()) is not None:
            self._answered = self._answered or (self._sent is not None and features.seq == self._sent.seq)
        if self._answered:
            self._send_next(now_s)
        elif self._sent is not None and now_s - self._sent_s > REPEAT_S:
            self._frames.put(self._sent)
            self._sent_s = now_s

    def _send_next(self, now_s: float) -> None:
        picture = self.reader.take()
        if picture is None:
            return
        try:
            frame = self._maker.frame(picture, self._seq)
        except BadPictureError as error:
            self._refuse(str(error))
            return
        self._frames.put(frame)
        self._sent, self._sent_s, self._answered = frame, now_s, False
        self._seq += 1
        self._due_s = max(self._due_s + 1.0 / self._settings.rate_hz, now_s)

    def _refuse(self, why: str) -> None:
        """Count a picture that cannot be used. Called by the reader's thread, too."""
        self._fault, self._fault_s = why, time.monotonic()
        self._bus.counters.count("bad_picture", f"{self._name}: {why}")

    def _state(self, now_s: float) -> CameraState:
        status, sent = self.reader.status(), self._sent
        fault = self._fault if now_s - self._fault_s < 2.0 * STATE_PERIOD_S else ""
        return CameraState(
            seq=self._seq,
            stamp_ns=time.time_ns(),
            robot=self._settings.robot,
            source=self._name[:200],
            problem=(status.problem or fault)[:300],
            model=status.facts.model,
            mode=status.facts.mode,
            battery_fraction=status.facts.battery_fraction,
            rate_hz=min(status.rate_hz, 1000.0),
            delay_s=self._settings.delay_s,
            width_px=sent.width_px if sent else 0,
            height_px=sent.height_px if sent else 0,
        )


def frame_settings(settings: CameraSettings) -> FrameSettings:
    """The part of the settings that frames need."""
    return FrameSettings(
        robot=settings.robot,
        width_px=settings.width_px,
        encoding=settings.encoding,
        jpeg_quality=settings.jpeg_quality,
        delay_s=settings.delay_s,
        lockstep=settings.camera.stepped,
        mask_rad=math.radians(settings.camera.url.mask_deg),
    )


def fisheye_of(settings: CameraSettings) -> FisheyeCalibration | None:
    """The calibration that the URL names.

    Raises:
        CalibrationFileError: it cannot be used.
    """
    file = settings.camera.url.fisheye
    return None if file is None else load_calibration(file)


def run(settings: CameraSettings, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop`.

    Raises:
        CalibrationFileError: the URL names a calibration that cannot be used.
    """
    camera = Camera(settings, bus, stop)
    bus.announce("camera")
    log.info("camera %s, frames stamped %.0f ms back", settings.camera.url.shown, 1e3 * settings.delay_s)
    camera.reader.start()
    try:
        while not stop.is_set():
            bus.wait(STEP_S)
            camera.step(time.monotonic())
    finally:
        stop.set()
        camera.reader.join(JOIN_S)
