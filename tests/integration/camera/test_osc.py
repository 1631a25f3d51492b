"""A camera over Open Spherical Camera: its quirk, its moods, its delay, and what happens without it."""

import time

import pytest

from tests.noisy_pictures import NoisyPictures, painted
from tests.osc_camera import OscCamera


class Remembered:
    """Pictures whose times of exposure are remembered, Unix nanoseconds."""

    def __init__(self) -> None:
        self._pictures = NoisyPictures(painted(128))
        self.exposed_ns: dict[bytes, int] = {}

    def __call__(self, now_s: float) -> bytes:
        jpeg = self._pictures(now_s)
        self.exposed_ns[jpeg] = time.time_ns()
        return jpeg


@pytest.fixture
def pictures():
    return Remembered()


def test_frames_come_byte_by_byte_with_battery_and_mode(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        serve(camera.url)
        assert listener.frame().data in pictures.exposed_ns
        state = listener.until(lambda s: s.rate_hz > 5.0)
        assert (state.battery_fraction, state.mode, state.model) == (0.63, "image", "RICOH THETA Z1")
        assert (state.width_px, state.height_px, state.problem) == (128, 64, "")
        assert camera.options["previewFormat"] == {"width": 1024, "height": 512, "framerate": 30}
        assert camera.options["_topBottomCorrection"] == "Apply"


def test_a_frame_says_when_it_was_exposed_and_not_when_it_came(pictures, serve, listener):
    with OscCamera(pictures, delay_s=0.4) as camera:
        serve(camera.url, delay_ms=400)
        late_s = []
        for _ in range(10):
            frame = listener.frame()
            late_s.append((frame.stamp_ns - pictures.exposed_ns[frame.data]) / 1e9)
        assert sorted(late_s)[5] == pytest.approx(0.0, abs=0.1)  # a whole period of the camera is 0.05
        assert listener.until(lambda s: s.width_px > 0).delay_s == 0.4


def test_a_camera_whose_mode_somebody_changes_is_changed_back(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        serve(camera.url)
        listener.frame()
        listener.until(lambda s: s.problem == "")
        camera.touch("video")
        listener.until(lambda s: s.problem == "the stream ended")
        listener.until(lambda s: s.problem == "" and s.rate_hz > 1.0)
        assert camera.mode == "image"
        assert camera.previews == 2


def test_a_camera_that_is_unplugged_is_said_to_be_gone_and_found_again(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        serve(camera.url)
        before = listener.frame()
        camera.unplug()
        listener.until(lambda s: "no connection" in s.problem)
        listener.no_frame_waits()
        assert listener.no_frame_waits()
        camera.plug()
        listener.until(lambda s: s.problem == "" and s.rate_hz > 1.0)
        assert listener.frame().seq > before.seq


def test_a_camera_that_falls_silent_is_asked_anew(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        serve(camera.url)
        listener.frame()
        camera.silent.set()
        listener.until(lambda s: "timed out" in s.problem)
        camera.silent.clear()
        listener.until(lambda s: s.problem == "")
        assert camera.previews >= 2


def test_a_camera_that_shows_the_same_picture_for_ever_hangs(serve, listener):
    still = NoisyPictures(painted(128))()
    with OscCamera(lambda _: still) as camera:
        serve(camera.url)
        listener.until(lambda s: "frozen: the same picture" in s.problem)


def test_a_camera_in_a_houses_network_wants_user_and_password(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        camera.user, camera.password = "THETAYL00100001", "00100001"
        serve(camera.url)
        listener.frame()
        state = listener.until(lambda s: s.width_px > 0)
        assert "00100001@" not in state.source
        assert "***" in state.source


def test_without_them_it_says_what_it_wants(pictures, serve, listener):
    with OscCamera(pictures) as camera:
        url = camera.url
        camera.user, camera.password = "THETAYL00100001", "00100001"
        serve(url)
        listener.until(lambda s: "HTTP 401, give its user and password" in s.problem)


def test_a_picture_of_another_shape_is_named_and_none_is_sent(serve, listener):
    square = NoisyPictures(painted(128)[:, :96].copy())
    with OscCamera(square) as camera:
        serve(camera.url)
        listener.until(lambda s: "twice as wide as high, expected, got 96 x 64" in s.problem)
        assert listener.no_frame_waits()


def test_a_camera_that_is_not_there_at_all_is_waited_for(pictures, serve, listener):
    camera = OscCamera(pictures)
    with camera:
        url = camera.url
    serve(url)
    listener.until(lambda s: "no connection" in s.problem)
    camera.plug()
    try:
        listener.frame()
    finally:
        camera.unplug()
