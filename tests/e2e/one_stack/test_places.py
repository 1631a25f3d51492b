"""Places and rules on real processes: named over HTTP and by command, driven to, and kept out of by name."""

import json
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.e2e.one_stack.conftest import MAP, Explored

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

DRIVE_S = 300.0


@pytest.fixture
def http(http: httpx.Client) -> Iterator[httpx.Client]:
    """Afterwards the map has no places and no rules."""
    yield http
    for what in ("rules", "places"):
        for mark in http.get(f"/api/maps/{MAP}/{what}").json():
            http.delete(f"/api/maps/{MAP}/{what}", params={"name": mark["name"]})


def topnav(explored: Explored, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "services.launcher", *words, "--data-dir", str(explored.data_dir)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DRIVE_S)


def start(http: httpx.Client, explored: Explored, **wish: Any) -> httpx.Response:
    return http.post(f"/api/robots/{explored.stack.robot}/missions", json={"map": MAP, **wish})


def ended(http: httpx.Client, explored: Explored, mission_id: str) -> dict[str, Any]:
    wait = {"timeout_s": DRIVE_S, "mission_id": mission_id}
    path = f"/api/robots/{explored.stack.robot}/mission/wait"
    return dict(http.get(path, params=wait, timeout=2 * DRIVE_S).json()["mission"])


def test_a_place_named_by_command_is_driven_to_by_name_and_home_too(
    http: httpx.Client, explored: Explored
) -> None:
    explored.game.begin(seed=1)
    named = topnav(explored, "place", "name", "Kitchen", "0", "--map", MAP)
    assert named.returncode == 0, named.stderr
    assert http.get(f"/api/maps/{MAP}/places").json() == [{"name": "Kitchen", "nodes": [0]}]
    figures = explored.data_dir / "goto.json"
    driven = topnav(explored, "goto", "--place", "kitchen", "--map", MAP, "--json", str(figures))
    assert driven.returncode == 0, driven.stderr
    report = json.loads(figures.read_text())
    assert (report["success"], report["place"]) == (True, "kitchen")
    wrong = topnav(explored, "goto", "--place", "kichen", "--map", MAP)
    assert wrong.returncode == 1
    assert "no place 'kichen'; nearest: 'Kitchen'" in wrong.stderr
    homeless = start(http, explored, action="home")
    assert homeless.status_code == 409
    assert "no place 'home'" in homeless.json()["got"]
    http.put(f"/api/maps/{MAP}/places", json={"name": "home", "nodes": [1]}).raise_for_status()
    begun = start(http, explored, action="home")
    assert begun.status_code == 202, begun.text
    mission = ended(http, explored, begun.json()["mission_id"])
    assert mission["state"] == "succeeded", mission["reason"]


def test_a_patrol_by_command_visits_places_in_rounds_and_leaves_out_what_is_forbidden(
    http: httpx.Client, explored: Explored
) -> None:
    explored.game.begin(seed=1)
    for node, name in enumerate(("Kitchen", "Bath", "Lab")):
        http.put(f"/api/maps/{MAP}/places", json={"name": name, "nodes": [node]}).raise_for_status()
    figures = explored.data_dir / "patrol.json"
    wish = ("mission", "start", "patrol", "--map", MAP, "--set", "rounds=2", "--json", str(figures))
    whole = topnav(explored, *wish, "--set", 'places=["kitchen", "bath"]')
    assert whole.returncode == 0, whole.stderr
    report = json.loads(figures.read_text())
    assert (report["visited"], report["missed"], report["reason"]) == (4, 0, "all 4 visits made")
    begun = start(http, explored, action="patrol", parameters={"places": ["bath", "lab"], "dwell_s": 5.0})
    assert begun.status_code == 202, begun.text
    rule = {"kind": "keep_out", "name": "no robots here", "nodes": [2]}
    http.put(f"/api/maps/{MAP}/rules", json=rule).raise_for_status()
    mission = ended(http, explored, begun.json()["mission_id"])
    assert (mission["state"], mission["failure"]) == ("failed", "forbidden")
    assert mission["reason"] == "1 of 2 visits made, missed: lab (forbidden)"


def test_a_forbidden_goal_is_refused_by_the_name_of_the_rule_until_it_is_lifted(
    http: httpx.Client, explored: Explored
) -> None:
    http.put(f"/api/maps/{MAP}/places", json={"name": "Lab", "nodes": [0]}).raise_for_status()
    ruled = topnav(explored, "rule", "keep-out", "no robots here", "--area", "Lab", "--map", MAP)
    assert ruled.returncode == 0, ruled.stderr
    wishes: tuple[dict[str, Any], ...] = ({"parameters": {"place": "lab"}}, {"goal_node": 0})
    for wish in wishes:
        answer = start(http, explored, action="goto", **wish)
        assert (answer.status_code, answer.json()["reason"]) == (409, "forbidden")
        assert "forbidden by rule 'no robots here'" in answer.json()["got"]
    used = topnav(explored, "place", "forget", "Lab", "--map", MAP)
    assert (used.returncode, "what rule 'no robots here' is about" in used.stderr) == (1, True)
    listed = topnav(explored, "rule", "list", "--map", MAP)
    assert "no robots here" in listed.stdout
    assert topnav(explored, "rule", "lift", "no robots here", "--map", MAP).returncode == 0
    begun = start(http, explored, action="goto", parameters={"place": "LAB"})
    assert begun.status_code == 202, begun.text
    assert ended(http, explored, begun.json()["mission_id"])["state"] == "succeeded"


def test_a_goal_that_becomes_forbidden_ends_the_mission_by_name(
    http: httpx.Client, explored: Explored
) -> None:
    explored.game.begin(seed=2)
    nodes = [node["node_id"] for node in http.get(f"/api/maps/{MAP}/nodes").json()]
    begun = start(http, explored, action="goto", goal_node=nodes[-1])
    assert begun.status_code == 202, begun.text
    rule = {"kind": "keep_out", "name": "wet paint", "nodes": nodes}
    http.put(f"/api/maps/{MAP}/rules", json=rule).raise_for_status()
    mission = ended(http, explored, begun.json()["mission_id"])
    assert (mission["state"], mission["failure"]) == ("failed", "forbidden")
    assert "rule 'wet paint'" in mission["reason"]
