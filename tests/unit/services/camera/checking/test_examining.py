"""From what was watched to a report: two fisheyes, mounts, clocks."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from services.camera.checking.examining import examine
from services.camera.checking.watching import Watched
from services.camera.frames import FrameMaker
from services.camera.mount.orientation import Orientation
from services.camera.service import frame_settings
from services.camera.settings import CameraSettings
from services.camera.source import Picture
from tests.fisheye_camera import FRONT_BACK, taken
from tests.painted_room import room


def report_of(watched, fisheye=None, **options):
    settings = CameraSettings(url="/pictures", width_px=512, **options)
    maker = FrameMaker(frame_settings(settings), settings.orientation, fisheye)
    return examine(settings, maker, fisheye, watched)


def watched(*pictures):
    kept = [Picture(picture, 10**18 + number) for number, picture in enumerate(pictures)]
    times = [float(number) for number in range(len(pictures))]
    return Watched(arrivals_s=times, clock_s=[1e9] * len(kept), kept=kept)


def sky(_, bearings):
    """Colours that change slowly all over the sphere."""
    return 128.0 + 60.0 * np.stack([bearings[..., 0], bearings[..., 1], bearings[..., 2]], axis=-1)


def test_two_fisheyes_that_fit_have_no_seam_and_others_have_one():
    picture = taken(sky, supersample=1)
    report, marked = report_of(watched(picture), FRONT_BACK)
    assert report.lenses
    assert report.seam < 2.0
    assert marked is not None
    half = picture.shape[1] // 2
    upside_down = np.hstack([picture[:, :half], picture[::-1, half:]])
    assert report_of(watched(upside_down), FRONT_BACK)[0].seam > 3.0


@pytest.mark.parametrize(
    "now",
    [Orientation(), Orientation.from_degrees(4.0, -3.0, 40.0), Orientation.from_degrees(180.0, 0.0, 0.0)],
)
def test_the_mount_that_is_told_is_that_of_the_camera_whatever_is_set_now(now):
    camera = Orientation.from_degrees(6.0, -2.0, 0.0)
    if abs(now.roll_rad) > 3.0:
        camera = Orientation.from_degrees(176.0, -2.0, 0.0)
    degrees = {
        f"{name}_deg": float(np.degrees(getattr(now, f"{name}_rad"))) for name in ("roll", "pitch", "heading")
    }
    report, _ = report_of(watched(room(camera.rotation, 1024)), **degrees)
    found = report.mount.roll_deg, report.mount.pitch_deg
    assert found == pytest.approx(np.degrees((camera.roll_rad, camera.pitch_rad)), abs=0.6)


def test_pictures_that_make_no_frame_are_counted_with_the_reason():
    good = cv2.imencode(".jpg", room(np.eye(3), 256))[1].tobytes()
    report, marked = report_of(watched(good[:-40], good[:-40]))
    assert (report.bad, report.width_px, marked) == (2, 0, None)
    assert "cut short" in report.bad_why


def test_a_clock_that_is_set_meanwhile_is_told():
    seen = watched(*[room(np.eye(3), 128)] * 3)
    assert report_of(seen)[0].clock_jump_s == 0.0
    set_back = replace(seen, clock_s=[1e9, 1e9 + 0.001, 1e9 - 2.0])
    assert report_of(set_back)[0].clock_jump_s == pytest.approx(-2.001)
    assert report_of(seen)[0].rate_hz == pytest.approx(1.0)
    assert report_of(Watched())[0].rate_hz is None
