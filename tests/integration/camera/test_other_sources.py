"""Motion JPEG over plain HTTP, folders played and stepped, and the process itself."""

import os
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np
import pytest

from services.camera.kinds import find_camera
from services.camera.source import SourceError
from shared.messages.features import Features
from shared.topics import FEATURES
from tests.noisy_pictures import NoisyPictures, painted


@pytest.fixture
def web():
    """Call it with a content type and a body: the URL of a server that sends them."""
    servers = []

    def started(content_type, body):
        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", content_type)
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                """Nothing on standard error."""

        server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
        servers.append(server)
        return f"http://127.0.0.1:{server.server_address[1]}/video"

    yield started
    for server in servers:
        server.shutdown()
        server.server_close()


def test_motion_jpeg_of_a_webcam_is_read(web):
    jpeg = NoisyPictures(painted(128))()
    part = b"--frame\r\nContent-Type: image/jpeg\r\n\r\n" + jpeg + b"\r\n"
    url = web("multipart/x-mixed-replace; boundary=frame", part * 2)
    source = find_camera(url).opener(threading.Event())()
    assert source.read().data == jpeg
    with pytest.raises(SourceError, match="the stream ended"):
        source.read()
    source.close()


def test_a_web_page_is_no_stream(web):
    with pytest.raises(SourceError, match="'text/html' came: is it the camera's page"):
        find_camera(web("text/html", b"<html>")).opener(threading.Event())()


def test_a_video_over_http_is_read_by_ffmpeg(web, tmp_path):
    file = tmp_path / "drive.avi"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (128, 64))
    for _ in range(5):
        writer.write(painted(128))
    writer.release()
    source = find_camera(web("video/x-msvideo", file.read_bytes())).opener(threading.Event())()
    assert source.read().data.shape == (64, 128, 3)
    source.close()


def test_a_device_that_is_not_there_is_named():
    with pytest.raises(SourceError, match="device /dev/video99 cannot be opened"):
        find_camera("v4l2:/dev/video99").opener(threading.Event())()


def test_a_stepped_folder_waits_for_the_features_of_each_picture(serve, listener, tmp_path):
    for name in ("a.jpg", "b.jpg"):
        (tmp_path / name).write_bytes(NoisyPictures(painted(128), seed=ord(name[0]))())
    features = listener.bus.publisher(FEATURES, robot="r1")
    serve(f"{tmp_path}?step=true")
    first = listener.frame()
    assert first.lockstep
    assert listener.frame().seq == first.seq  # sent again, as nobody answered
    features.put(
        Features(
            seq=first.seq, stamp_ns=first.stamp_ns, robot="r1", lockstep=True, pipeline="sift",
            lonlat_rad=np.zeros((0, 2), np.float32), scores=np.zeros(0, np.float32),
            descriptors=np.zeros((0, 128), np.uint8),
        )
    )  # fmt: skip
    listener.until(lambda s: s.seq == first.seq + 2)
    assert (tmp_path / "b.jpg").read_bytes() == listener.frame().data


@pytest.mark.parametrize(
    ("variables", "said"),
    [
        ({}, "camera: CAMERA_URL: a camera's URL expected"),
        ({"CAMERA_URL": "ftp://x"}, "camera: CAMERA_URL: a camera's URL such as"),
        ({"CAMERA_URL": "/x?fisheye=/none.json"}, "camera: /none.json: No such file or directory"),
        ({"CAMERA_URL": "/x", "CAMERA_WITH": "3"}, "camera: CAMERA_WITH: no such setting"),
    ],
)
def test_a_process_that_cannot_work_ends_with_one_line(variables, said, router_endpoint):
    run = subprocess.run(
        [sys.executable, "-m", "services.camera"],
        env=os.environ | {"TOPNAV_ENDPOINT": router_endpoint, "TOPNAV_LOG_LEVEL": "ERROR"} | variables,
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert run.returncode != 0
    (line,) = [one for one in run.stderr.splitlines() if one]
    assert line.startswith(said)
