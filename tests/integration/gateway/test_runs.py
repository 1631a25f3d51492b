"""Runs through the gateway: what ends on the bus and what commands leave is listed over HTTP."""

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import httpx
import pytest

from services.gateway.live.mission_log import FILE
from shared.bus import wait_until
from shared.runs import CommandRun
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner

STARTED = datetime(2020, 1, 1, tzinfo=UTC)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the gateway keeps runs."""
    return tmp_path_factory.mktemp("stack") / "runs"


@pytest.fixture(scope="module")
def gateway(endpoint: str, planner: Planner, folder: Path) -> Iterator[str]:
    """A gateway with this folder."""
    assert planner
    yield from serve_gateway(endpoint, ["planner"], runs_dir=folder)


def listed(http: httpx.Client, **query: object) -> list[dict[str, object]]:
    answer = http.get("/api/runs", params=query)  # type: ignore[arg-type]
    assert answer.status_code == 200, answer.text
    return list(answer.json())


def test_a_mission_is_listed_once_it_ended_and_only_once(
    http: httpx.Client, planner: Planner, folder: Path
) -> None:
    assert listed(http) == []
    http.post("/api/robots/r1/missions", json={"action": "explore", "map": "flat", "seed": 3})

    def under_way() -> bool:
        planner.say(step=1)
        return http.get("/api/robots/r1").status_code == 200

    assert wait_until(under_way, WAIT_S)
    for _ in range(3):
        planner.say(state="succeeded", step=40, nodes=9, reason="all seen")
    assert wait_until(lambda: bool(listed(http)), WAIT_S)
    planner.say(mission_id="m2", action="goto", state="running")
    planner.say(mission_id="m2", action="goto", state="failed", failure="lost")
    assert wait_until(lambda: len(listed(http)) == 2, WAIT_S)
    second, first = listed(http)
    assert (first["id"], first["source"], first["kind"], first["map"], first["outcome"]) == (
        "mission:r1:m1", "mission", "explore", "flat", "succeeded",
    )  # fmt: skip
    assert first["figures"] == {
        "steps": 40, "nodes": 9, "edges": 0, "open_directions": 0, "similarity": 0,
        "seed": 3, "reason": "all seen",
    }  # fmt: skip
    assert str(first["started"]) < str(first["ended"])
    assert (second["id"], second["outcome"]) == ("mission:r1:m2", "failed")
    assert (folder / FILE).read_text().count("\n") == 2


def test_a_command_is_listed_and_broken_files_are_counted(http: httpx.Client, folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    run = CommandRun(
        command="explore",
        started=STARTED,
        ended=datetime(2999, 1, 1, tzinfo=UTC),
        world="village",
        map="v",
        figures={"nodes": 9, "coverage": 0.5, "outcome": "succeeded"},
    )
    (folder / run.file_name).write_text(run.model_dump_json())
    (folder / "29990101T000000Z-broken.json").write_text("{")
    (newest,) = listed(http, limit=1)
    assert newest == {
        "id": "command:29990101T000000Z-explore",
        "source": "command",
        "kind": "explore",
        "title": "topnav explore in village",
        "map": "v",
        "world": "village",
        "started": "2020-01-01T00:00:00Z",
        "ended": "2999-01-01T00:00:00Z",
        "outcome": "succeeded",
        "figures": {"nodes": 9, "coverage": 0.5},
    }
    listed(http)
    assert "topnav_gateway_runs_broken 1.0" in http.get("/metrics").text


@pytest.mark.parametrize("limit", ["0", "-1", "1001", "x", "1.5"])
def test_the_limit_has_bounds(http: httpx.Client, limit: str) -> None:
    assert http.get(f"/api/runs?limit={limit}").status_code == 422


def test_a_name_that_was_pointed_here_sees_no_runs(http: httpx.Client) -> None:
    answer = http.get("/api/runs", headers={"host": "evil.example"})
    assert (answer.status_code, answer.json()["title"]) == (403, "foreign host")
