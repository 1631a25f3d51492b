"""A phone's photo on real processes: located by command, driven to, and faced."""

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import ExifTags, Image

from experiments.phone_photos.taking import LONG_PX, SHORT_PX, Shot, taken
from shared.frames.decoding import decode_picture
from shared.geometry.photo.plane import USUAL_RAD
from shared.messages.simulation import Pose
from tests.e2e.near_node import hiding_place_near_a_node
from tests.e2e.one_stack.conftest import MAP, Explored

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

FOCAL_MM = 20
"""In 35 mm film, a wide lens: 82 degrees over the longer side."""
FOV_RAD = 1.43
NEAR_M, NEAR_RAD = 0.6, math.radians(12.0)


@pytest.fixture
def shot(explored: Explored) -> Shot:
    """How somebody holds a phone beside the node farthest from where the robot starts."""
    start = explored.game.begin(seed=1).pose
    pose = hiding_place_near_a_node(explored.result, explored.space, start)
    return Shot(pose, pitch_rad=-0.1, roll_rad=0.03, fov_rad=FOV_RAD, fov_known=True, portrait=False)


@pytest.fixture
def photo(explored: Explored, shot: Shot, tmp_path: Path) -> Path:
    """The file that the phone writes."""
    frame = taken(shot, lambda pose: decode_picture(explored.game.experimenter.look(pose)), USUAL_RAD)
    bgr = np.frombuffer(frame.data, np.uint8).reshape(frame.height_px, frame.width_px, 3)
    exif = Image.Exif()
    exif.get_ifd(ExifTags.IFD.Exif).update(
        {
            ExifTags.Base.FocalLengthIn35mmFilm: FOCAL_MM,
            ExifTags.Base.ExifImageWidth: LONG_PX,
            ExifTags.Base.ExifImageHeight: SHORT_PX,
        }
    )
    path = tmp_path / "phone.jpg"
    Image.fromarray(bgr[:, :, ::-1]).save(path, quality=92, exif=exif)
    return path


def topnav(explored: Explored, command: str, photo: Path) -> dict[str, Any]:
    figures = photo.with_suffix(".json")
    words = [command, "--photo", str(photo), "--map", MAP, "--json", str(figures)]
    run = subprocess.run(
        [sys.executable, "-m", "services.launcher", *words, "--data-dir", str(explored.data_dir)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    return dict(json.loads(figures.read_text()))


def off(pose: Pose, truth: Pose) -> tuple[float, float]:
    """How far a pose is from another, metres, and by how much it looks elsewhere, radians."""
    turned_rad = math.remainder(pose.yaw_rad - truth.yaw_rad, math.tau)
    return math.hypot(pose.x_m - truth.x_m, pose.y_m - truth.y_m), abs(turned_rad)


def test_a_photo_is_located_near_a_node_and_says_which_way_it_looks(
    explored: Explored, shot: Shot, photo: Path
) -> None:
    report = topnav(explored, "locate", photo)
    assert report["verdict"] == "found"
    told = report["places"][0]
    node = explored.result.truth.poses[told["node"]]
    cos, sin = math.cos(node.yaw_rad), math.sin(node.yaw_rad)
    place = Pose(
        x_m=node.x_m + cos * told["ahead_m"] - sin * told["left_m"],
        y_m=node.y_m + sin * told["ahead_m"] + cos * told["left_m"],
        yaw_rad=node.yaw_rad + math.radians(told["looks_deg"]),
    )
    off_m, off_rad = off(place, shot.pose)
    assert off_m < NEAR_M
    assert off_rad < NEAR_RAD


def test_the_robot_drives_to_where_a_photo_was_taken_and_looks_as_it_does(
    explored: Explored, shot: Shot, photo: Path
) -> None:
    report = topnav(explored, "goto", photo)
    assert (report["success"], report["photo"], report["image"]) == (True, str(photo), None)
    off_m, off_rad = off(explored.game.experimenter.settled_truth().pose, shot.pose)
    assert off_m < NEAR_M
    assert off_rad < NEAR_RAD
