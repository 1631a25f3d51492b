"""Broken goal uploads against the gateway as a process: refused, counted, nothing written, no memory lost."""

import contextlib
import os
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

import httpx
import pytest
from websockets.sync.client import connect

from services.gateway.service import GRACE_S
from shared.bus import Bus, wait_until
from shared.topics import MISSION
from shared.web.server import CLOSING_S
from tests.integration.gateway.corpus import Upload, bomb, broken, convertible
from tests.integration.gateway.gateway_process import ASK_S, ROOT, WAIT_S, Process, answers, send, started
from tests.integration.gateway.standins import FeatureService

BROKEN = broken()


def refused(process: Process) -> dict[str, float]:
    counts = {}
    text = httpx.get(f"{process.address}/metrics", trust_env=False, timeout=WAIT_S).text
    for line in text.splitlines():
        if line.startswith("topnav_gateway_uploads_refused_total{"):
            counts[line.split('"')[1]] = float(line.split()[-1])
    return counts


def test_the_corpus_is_large_enough() -> None:
    assert len(BROKEN) >= 25
    assert len({upload.name for upload in BROKEN}) == len(BROKEN)


@pytest.mark.parametrize("upload", BROKEN, ids=lambda upload: upload.name)
def test_a_broken_upload_is_refused_counted_and_leaves_nothing(
    process: Process, features: FeatureService, upload: Upload
) -> None:
    before, asked, files = refused(process), len(features.extracted), process.files()
    answer = send(process, upload.content_type, upload.body)
    assert answer.status_code == upload.status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["type"] == f"urn:topnav:problem:{upload.reason}"
    assert answer.json()["expected"]
    assert refused(process).get(upload.reason, 0.0) == before.get(upload.reason, 0.0) + 1.0
    assert len(features.extracted) == asked
    assert process.files() == files
    assert answers(process.address)


@pytest.mark.parametrize(("name", "content_type", "body"), convertible(), ids=lambda value: str(value)[:24])
def test_unusual_pictures_are_converted(process: Process, name: str, content_type: str, body: bytes) -> None:
    files = process.files()
    answer = send(process, content_type, body)
    assert answer.status_code == 200, f"{name}: {answer.text}"
    assert process.files() == files


def test_a_bomb_is_refused_at_once_and_costs_no_memory(process: Process) -> None:
    body = bomb(30_000, 30_000)
    assert len(body) < 200_000
    before, walls_s = process.rss_bytes(), []
    for _ in range(10):
        began_s = time.monotonic()
        assert send(process, "image/png", body).status_code == 413
        walls_s.append(time.monotonic() - began_s)
    assert statistics.median(walls_s) < 1.0  # unpacking one takes ten, other processes may hold up some
    assert process.rss_bytes() - before < 50_000_000


@pytest.mark.parametrize(
    "name", ["%00", "a%0a", "..%5cx", "..%2f..%2fetc", "%2e%2e", "A", "x" * 65, "r1;ls", "%C3%A4", "*"]
)
def test_names_that_are_paths_or_patterns_are_refused(process: Process, name: str) -> None:
    good = convertible()[-1]
    for answer in (send(process, good[1], good[2], robot=name), send(process, good[1], good[2], name=name)):
        assert answer.status_code in (404, 422), answer.text
        assert answer.headers["content-type"] == "application/problem+json"


def test_an_absent_feature_service_is_named(tmp_path: Path) -> None:
    lonely = started("tcp/127.0.0.1:9", tmp_path)
    try:
        good = convertible()[-1]
        answer = send(lonely, good[1], good[2])
        assert (answer.status_code, answer.json()["service"]) == (503, "features")
    finally:
        lonely.end()


def test_sigterm_ends_it_although_sockets_are_open_and_a_question_waits(
    endpoint: str, robot_bus: Bus, tmp_path: Path
) -> None:
    assert GRACE_S + CLOSING_S < 2.0, "so long it may take at most; the clock tells little on a busy machine"
    unanswered, held = robot_bus.requests(MISSION, robot="mute"), []
    robot_bus.announce("mute")

    def asked() -> bool:
        held.append(unanswered.take())
        return held[-1] is not None

    running = started(endpoint, tmp_path, ["mute"])
    live = f"{running.address.replace('http', 'ws', 1)}/api/robots/r1/live"
    with (
        connect(live, proxy=None, open_timeout=WAIT_S) as one,
        connect(live, proxy=None, open_timeout=WAIT_S) as two,
    ):
        one.recv(timeout=WAIT_S)
        two.recv(timeout=WAIT_S)
        asking = threading.Thread(target=_ask_in_vain, args=(f"{running.address}/api/robots/mute/mission",))
        asking.start()
        assert wait_until(asked, WAIT_S)
        running.end()  # within WAIT_S, while the answer is waited for longer
        asking.join(WAIT_S)


def _ask_in_vain(url: str) -> None:
    with contextlib.suppress(httpx.HTTPError):
        httpx.get(url, trust_env=False, timeout=2 * ASK_S)


def test_a_reachable_address_without_a_token_ends_the_start(tmp_path: Path) -> None:
    environment = {**os.environ, "GATEWAY_HOST": "0.0.0.0", "PYTHONPATH": str(ROOT)}
    ended = subprocess.run(
        [sys.executable, "-m", "services.gateway"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        timeout=4 * WAIT_S,
        check=False,
    )
    assert ended.returncode == 2
    assert b"GATEWAY_TOKEN is empty" in ended.stderr
