"""A camera service on a bus of its own, and everybody who listens to it."""

import threading
from collections.abc import Callable, Iterator

import pytest

from services.camera.service import run
from services.camera.settings import CameraSettings
from shared.bus import Bus, Inbox, open_bus, wait_until
from shared.messages.camera import CameraState
from shared.messages.sensors import Frame
from shared.topics import CAMERA_STATE, FRAME

SOON_S = 30.0


class Listener:
    """Frames and states as they came."""

    def __init__(self, bus: Bus) -> None:
        self.bus = bus
        self._frames: Inbox[Frame] = bus.subscribe(FRAME, robot="r1")
        self._states: Inbox[CameraState] = bus.subscribe(CAMERA_STATE, robot="r1")
        self.state: CameraState | None = None

    def frame(self) -> Frame:
        """The next frame."""
        found: list[Frame] = []
        assert wait_until(lambda: bool(found.extend(self._frames.take_all()) or found), SOON_S)
        return found[-1]

    def no_frame_waits(self) -> bool:
        """Whether none has come since the last look."""
        return not self._frames.take_all()

    def until(self, holds: Callable[[CameraState], bool]) -> CameraState:
        """The first state for which this holds."""

        def seen() -> bool:
            for state in self._states.take_all():
                self.state = state
                if holds(state):
                    return True
            return False

        assert wait_until(seen, SOON_S), f"the last state was {self.state}"
        assert self.state is not None
        return self.state


@pytest.fixture
def listener(router_endpoint: str) -> Iterator[Listener]:
    """Somebody who hears what the camera says."""
    with open_bus(router_endpoint, "tcp/127.0.0.1:0", None) as bus:
        yield Listener(bus)


@pytest.fixture
def serve(router_endpoint: str) -> Iterator[Callable[..., None]]:
    """Call it with settings: a camera service in a thread of this process."""
    stops: list[tuple[threading.Event, threading.Thread]] = []

    def started(url: str, **settings: object) -> None:
        stop = threading.Event()

        def loop() -> None:
            with open_bus(router_endpoint, "tcp/127.0.0.1:0", None) as bus:
                run(CameraSettings(url=url, **settings), bus, stop)

        thread = threading.Thread(target=loop, daemon=True)
        thread.start()
        stops.append((stop, thread))

    yield started
    for stop, _ in stops:
        stop.set()
    for _, thread in stops:
        thread.join(SOON_S)
        assert not thread.is_alive()
