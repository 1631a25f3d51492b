"""`topnav camera check` as a process: what it says of folders, streams and cameras that are not well."""

import io
import json
import os
import subprocess
import sys
import threading

import cv2
import numpy as np
import pytest

from services.camera.mount.orientation import Orientation
from tests.noisy_pictures import NoisyPictures
from tests.osc_camera import OscCamera
from tests.painted_room import room
from tests.stream_cameras import StreamCamera

LEVEL = room(np.eye(3), 512)
BRIGHT, DARK = "\x1b[107m", "\x1b[40m"


def process(folder, *options, **variables):
    """A check that writes its report and its picture into a folder."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("CAMERA_")}
    files = ["--json", str(folder / "report.json"), "--picture", str(folder / "marked.png")]
    return subprocess.Popen(
        [sys.executable, "-m", "services.launcher", "camera", "check", *options, *files],
        env=kept | variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip


def check(folder, *options, **variables):
    """Exit code, what was said, and the report."""
    with process(folder, *options, **variables) as running:
        said = running.communicate(timeout=120)[0]
    report = folder / "report.json"
    return running.returncode, said, json.loads(report.read_text("utf-8")) if report.exists() else {}


class Screen:
    """What the check's terminal shows: bright or dark, as it comes."""

    def __init__(self, running):
        self.bright, self._running, self.said = False, running, io.StringIO()
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def _read(self):
        for letter in iter(lambda: self._running.stdout.read(1), ""):
            self.said.write(letter)
            end = self.said.getvalue()[-7:]
            self.bright = (self.bright or end.endswith(BRIGHT)) and not end.endswith(DARK)

    def join(self):
        self._thread.join(120)
        return self.said.getvalue()


def test_a_folder_of_level_panoramas_is_well(tmp_path):
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    for number in range(4):
        (pictures / f"{number}.jpg").write_bytes(NoisyPictures(LEVEL, seed=number)())
    code, said, report = check(tmp_path, f"{pictures}?rate=20&loop=true", "--seconds", "1")
    assert (code, report["problems"]) == (0, [])
    assert report["rate_hz"] == pytest.approx(20.0, rel=0.25)
    assert report["mount"]["lean_deg"] < 0.5
    assert (report["from_deg"], report["to_deg"]) == (-90.0, 90.0)
    assert report["passed_on"]
    for word in ("rate", "frames", "stamp", "level", "seam", "the whole sphere", "AHEAD"):
        assert word in said
    assert cv2.imread(str(tmp_path / "marked.png")).shape == (800, 1600, 3)


def test_a_video_file_is_looked_at_to_its_end(tmp_path):
    file = tmp_path / "drive.avi"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"MJPG"), 10.0, (512, 256))
    for _ in range(12):
        writer.write(LEVEL)
    writer.release()
    code, _, report = check(tmp_path, str(file))
    assert (code, report["pictures"], report["problems"]) == (0, 12, [])


def test_a_camera_that_leans_is_told_what_makes_it_level(tmp_path):
    leaning = Orientation.from_degrees(5.0, -3.0, 0.0)
    pictures = NoisyPictures(room(leaning.rotation, 512))
    with StreamCamera(pictures) as camera:
        code, said, report = check(tmp_path, camera.url, "--seconds", "1")
        assert code == 1
        assert "frames lean by" in said
        mount = report["mount"]
        assert (mount["roll_deg"], mount["pitch_deg"]) == pytest.approx((5.0, -3.0), abs=0.6)
        levelled = {"CAMERA_ROLL_DEG": str(mount["roll_deg"]), "CAMERA_PITCH_DEG": str(mount["pitch_deg"])}
        code, _, report = check(tmp_path, camera.url, "--seconds", "1", **levelled)
    assert (code, report["problems"]) == (0, [])
    assert report["mount"]["lean_deg"] < 0.5
    assert report["mount"]["roll_deg"] == pytest.approx(5.0, abs=0.8)


@pytest.mark.parametrize("rtsp", [False, True], ids=["http", "rtsp"])
def test_the_delay_of_a_stream_is_measured_by_a_screen_before_it(tmp_path, rtsp):
    screens = []
    dim = np.clip(LEVEL * 0.5, 0, 255).astype(np.uint8)
    lit = dim.copy()
    lit[100:160, 300:360] = 240
    seen = {False: NoisyPictures(dim), True: NoisyPictures(lit)}
    with (
        StreamCamera(
            lambda now_s: seen[bool(screens) and screens[0].bright](now_s), 20.0, 0.5, rtsp=rtsp
        ) as camera,
        process(tmp_path, camera.url, "--flash", "--seconds", "8") as running,
    ):
        screens.append(Screen(running))
        said = screens[0].join()
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert report["delay_s"] == pytest.approx(0.55, abs=0.1)  # and half a picture
    assert f"set CAMERA_DELAY_MS={1e3 * report['delay_s']:.0f}" in said
    assert running.returncode == 1


def test_a_screen_that_is_not_in_sight_is_said(tmp_path):
    with StreamCamera(NoisyPictures(LEVEL)) as camera:
        code, said, report = check(tmp_path, camera.url, "--flash", "--seconds", "6")
    assert (code, report["delay_s"]) == (1, None)
    assert "no screen seen" in said


def test_a_theta_says_its_model_and_battery(tmp_path):
    with OscCamera(NoisyPictures(LEVEL)) as camera:
        code, said, report = check(tmp_path, "--seconds", "1", TOPNAV_CAMERA=camera.url)
    assert code == 0, said
    assert (report["model"], report["battery"], report["mode"]) == ("RICOH THETA Z1", 0.63, "image")
    assert report["stamp_delay_s"] == 0.4
    assert "400 ms before they come, which is usual for such a camera: --flash measures it" in said


@pytest.mark.parametrize(
    ("picture", "wrong"),
    [
        (LEVEL[:, :340], "twice as wide as high, expected, got 340 x 256"),
        (np.repeat(LEVEL[:, 100:356], 2, axis=1), "left and right edge of the picture do not meet"),
        (
            np.pad(LEVEL[90:166], ((90, 90), (0, 0), (0, 0))),
            "of what is within 55 degrees of the horizon is black",
        ),
    ],
    ids=["4:3", "no whole turn", "black bars"],
)
def test_a_picture_that_is_no_panorama_is_named(tmp_path, picture, wrong):
    with StreamCamera(NoisyPictures(np.ascontiguousarray(picture))) as camera:
        code, said, report = check(tmp_path, camera.url, "--seconds", "1")
    assert code == 1
    assert wrong in said
    assert any(wrong in problem for problem in report["problems"])


def test_a_camera_that_is_slow_hangs_or_is_not_there_is_named(tmp_path):
    with StreamCamera(NoisyPictures(LEVEL), rate_hz=2.0) as camera:
        code, said, _ = check(tmp_path, camera.url, "--seconds", "3")
        assert (code, "the robot stands between them" in said) == (1, True), said
    still = NoisyPictures(LEVEL)()
    with StreamCamera(lambda _: still) as camera:
        code, said, report = check(tmp_path, camera.url, "--seconds", "1")
        assert (code, report["pictures"]) == (1, 1), said
        assert "sends the same again and again" in said
    code, said, report = check(tmp_path, camera.url, "--seconds", "1")
    assert (code, report["width_px"]) == (1, 0)
    assert "no picture that can be used: no connection" in said


def test_what_names_no_camera_is_one_line(tmp_path):
    code, said, report = check(tmp_path, "ftp://x")
    assert (code, report) == (1, {})
    assert said.startswith("topnav: CAMERA_URL: a camera's URL such as")
