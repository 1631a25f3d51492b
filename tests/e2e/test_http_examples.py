"""The HTTP examples of the README work against a running stack."""

import os
import shutil
import subprocess

import pytest

from services.launcher.drawing.pictures import save_picture
from tests.e2e.near_node import hiding_place_near_a_node

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(shutil.which("curl") is None, reason="the example is written with curl"),
]


def run_example(repository, explored, picture):
    environment = {**os.environ, "TOPNAV_URL": explored.stack.gateway_url, "TOPNAV_TOKEN": ""}
    command = [str(repository / "deploy/examples/goto.sh"), "small", str(picture)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)


def test_a_picture_sent_with_curl_brings_the_robot_there(explored, repository, tmp_path):
    game = explored.game
    start = game.begin(seed=1).pose
    picture = game.hide(hiding_place_near_a_node(explored.result, explored.space, start))
    save_picture(tmp_path / "goal.png", picture)
    answer = run_example(repository, explored, tmp_path / "goal.png")
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert '"verdict":"found"' in answer.stdout
    assert '"state":"succeeded"' in answer.stdout


def test_a_picture_of_the_wrong_shape_is_refused_with_a_reason(explored, repository, tmp_path):
    from PIL import Image

    Image.new("RGB", (100, 100)).save(tmp_path / "square.png")
    answer = run_example(repository, explored, tmp_path / "square.png")
    assert answer.returncode != 0
    assert "expected" in answer.stdout
