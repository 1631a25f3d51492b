"""The HTTP examples of the README work against a running stack."""

import os
import shutil
import subprocess

import httpx
import pytest

from services.launcher.drawing.pictures import save_picture
from tests.e2e.near_node import hiding_place_near_a_node
from tests.e2e.one_stack.conftest import MAP
from tests.readme import examples

pytestmark = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(shutil.which("curl") is None, reason="the example is written with curl"),
]


def run_example(repository, explored, picture):
    environment = {**os.environ, "TOPNAV_URL": explored.stack.gateway_url, "TOPNAV_TOKEN": ""}
    command = [str(repository / "deploy/examples/goto.sh"), MAP, str(picture)]
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


def test_the_two_calls_of_the_readme_send_the_robot_off(explored, tmp_path):
    game = explored.game
    start = game.begin(seed=2).pose
    picture = game.hide(hiding_place_near_a_node(explored.result, explored.space, start))
    save_picture(tmp_path / "goal.png", picture)
    answer = subprocess.run(
        ["bash", "-ec", examples("bash")[1].replace("map=flat", f"map={MAP}")],
        env={**os.environ, "TOPNAV_URL": explored.stack.gateway_url},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert '"verdict":"found"' in answer.stdout
    assert '"action":"goto"' in answer.stdout
    robot = f"{explored.stack.gateway_url}/api/robots/{explored.stack.robot}"
    ended = httpx.get(f"{robot}/mission/wait", params={"timeout_s": 60}, timeout=90).json()
    assert ended["mission"]["state"] == "succeeded"


def test_a_picture_of_the_wrong_shape_is_refused_with_a_reason(explored, repository, tmp_path):
    from PIL import Image

    Image.new("RGB", (100, 100)).save(tmp_path / "square.png")
    answer = run_example(repository, explored, tmp_path / "square.png")
    assert answer.returncode != 0
    assert "expected" in answer.stdout
