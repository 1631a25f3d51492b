"""Missions through the gateway: every order reaches the planner, every refusal reaches the asker."""

import threading

import httpx
import pytest

from services.gateway.routes import missions
from services.gateway.settings import GatewaySettings
from shared.bus import Bus, wait_until
from shared.messages.missions import MissionStatus
from shared.topics import STATUS
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner


@pytest.fixture(autouse=True)
def _idle(planner: Planner) -> None:
    planner.status = MissionStatus(robot="r1")


def test_explore_is_handed_on(http: httpx.Client, planner: Planner) -> None:
    answer = http.post("/api/robots/r1/missions", json={"action": "explore", "map": "flat", "seed": 3})
    assert answer.status_code == 202, answer.text
    assert answer.headers["location"] == "/api/robots/r1/mission"
    assert (answer.json()["mission_id"], answer.json()["state"]) == ("m1", "running")
    wish = planner.asked[-1]
    assert (wish.action, wish.map, wish.seed, wish.goal_node, wish.max_steps) == (
        "explore",
        "flat",
        3,
        None,
        20_000,
    )


def test_goto_names_a_node(http: httpx.Client, planner: Planner) -> None:
    answer = http.post("/api/robots/r1/missions", json={"action": "goto", "map": "flat", "goal_node": 7})
    assert answer.status_code == 202
    assert (planner.asked[-1].action, planner.asked[-1].goal_node) == ("goto", 7)


def test_a_kind_of_mission_nobody_knows_is_refused_by_name(http: httpx.Client) -> None:
    answer = http.post("/api/robots/r1/missions", json={"action": "fly", "map": "flat"})
    assert answer.status_code == 422
    assert "unknown mission 'fly', this planner knows explore, goto" in answer.json()["got"]


@pytest.mark.parametrize("control", ["pause", "status"])
def test_steering_is_no_kind_of_mission(http: httpx.Client, planner: Planner, control: str) -> None:
    asked = len(planner.asked)
    answer = http.post("/api/robots/r1/missions", json={"action": control, "map": "flat"})
    assert (answer.status_code, len(planner.asked)) == (422, asked)


def test_parameters_are_handed_on(http: httpx.Client, planner: Planner) -> None:
    body = {"action": "goto", "map": "flat", "parameters": {"goal_node": 7}}
    assert http.post("/api/robots/r1/missions", json=body).status_code == 202
    assert planner.asked[-1].parameters == {"goal_node": 7}


def test_kinds_are_those_of_the_planner(http: httpx.Client) -> None:
    kinds = {kind["name"]: kind for kind in http.get("/api/robots/r1/mission-kinds").json()}
    assert {"explore", "goto"} <= kinds.keys()
    assert "goal_node" in kinds["goto"]["parameters"]["properties"]


@pytest.mark.parametrize(
    ("action", "state"),
    [("pause", "paused"), ("resume", "running"), ("cancel", "cancelled"), ("finish", "succeeded")],
)
def test_missions_are_steered(http: httpx.Client, planner: Planner, action: str, state: str) -> None:
    answer = http.post(f"/api/robots/r1/missions/{action}?mission_id=m1")
    assert (answer.status_code, answer.json()["state"]) == (200, state)
    assert planner.asked[-1].mission_id == "m1"
    assert http.get("/api/robots/r1/mission").json()["state"] == state


def test_a_refusal_comes_in_the_planners_words(http: httpx.Client) -> None:
    answer = http.post("/api/robots/r1/missions", json={"action": "goto", "map": "flat", "goal_node": 404})
    assert answer.status_code == 409
    assert answer.json()["got"] == "the map has no node 404"


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ({"action": "Fly!", "map": "flat"}, "action"),
        ({"action": "explore", "map": "flat", "parameters": [1]}, "parameters"),
        ({"action": "explore"}, "map"),
        ({"action": "explore", "map": "../etc"}, "map"),
        ({"action": "explore", "map": "a\n"}, "map"),
        ({"action": "explore", "map": "flat", "seed": "3"}, "seed"),
        ({"action": "explore", "map": "flat", "seed": -1}, "seed"),
        ({"action": "explore", "map": "flat", "seed": 1.5}, "seed"),
        ({"action": "explore", "map": "flat", "seed": True}, "seed"),
        ({"action": "explore", "map": "flat", "seed": 2**70}, "seed"),
        ({"action": "explore", "map": "flat", "sed": 1}, "sed"),
        ([1, 2], ""),
        ("explore", ""),
    ],
)
def test_wrong_bodies_name_the_field(http: httpx.Client, planner: Planner, body: object, where: str) -> None:
    asked = len(planner.asked)
    answer = http.post("/api/robots/r1/missions", json=body)
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["errors"][0]["where"] == where
    assert len(planner.asked) == asked


@pytest.mark.parametrize(
    "body",
    [
        b'{"action":"explore","map":"flat","seed":NaN}',
        b'{"action":"explore","map":"flat","seed":Infinity}',
        b'{"action":"explore","map":"flat","map":"other"}',
        b"",
        b"{",
        b"\xff\xfe",
        b"[" * 20_000,
        b'{"action":"explore","map":"flat","seed":' + b"9" * 10_000 + b"}",
    ],
)
def test_what_is_not_json_is_refused(http: httpx.Client, body: bytes) -> None:
    answer = http.post("/api/robots/r1/missions", content=body, headers={"content-type": "application/json"})
    assert (answer.status_code, answer.json()["title"]) == (422, "invalid json")


def test_another_content_type_is_refused(http: httpx.Client) -> None:
    assert http.post("/api/robots/r1/missions", data={"action": "explore"}).status_code == 415


def test_a_long_json_body_is_refused(http: httpx.Client) -> None:
    content = b'{"action":"explore","map":"' + b"a" * 200_000 + b'"}'
    answer = http.post(
        "/api/robots/r1/missions", content=content, headers={"content-type": "application/json"}
    )
    assert answer.status_code == 413


def test_waiting_ends_with_the_mission(
    http: httpx.Client, planner: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    longest_s = 4 * WAIT_S
    monkeypatch.setattr(missions, "ASK_AGAIN_S", longest_s)  # what ends it sooner is the news
    http.post("/api/robots/r1/missions", json={"action": "explore", "map": "flat"})
    answers: list[httpx.Response] = []
    path = f"/api/robots/r1/mission/wait?timeout_s={longest_s}&mission_id=m1"
    waiting = threading.Thread(target=lambda: answers.append(http.get(path, timeout=2 * longest_s)))
    asked = len(planner.asked)
    waiting.start()
    assert wait_until(lambda: len(planner.asked) > asked, WAIT_S)
    assert not answers
    planner.say(state="succeeded", reason="arrived")  # once, maybe before the wait has its first answer
    waiting.join(WAIT_S)
    assert answers[0].json()["done"] is True
    assert answers[0].json()["mission"]["state"] == "succeeded"


def test_waiting_in_vain_says_so(http: httpx.Client) -> None:
    http.post("/api/robots/r1/missions", json={"action": "explore", "map": "flat"})
    answer = http.get("/api/robots/r1/mission/wait?timeout_s=0.3")
    assert (answer.status_code, answer.json()["done"]) == (200, False)


@pytest.mark.parametrize("timeout", ["-1", "nan", "inf", "1e9", "x"])
def test_a_wait_has_bounds(http: httpx.Client, timeout: str) -> None:
    assert http.get(f"/api/robots/r1/mission/wait?timeout_s={timeout}").status_code == 422


def test_a_robot_nobody_heard_of_is_not_found(http: httpx.Client) -> None:
    answer = http.get("/api/robots/ghost/mission")
    assert (answer.status_code, answer.json()["title"]) == (404, "unknown robot")


def test_a_robot_without_planner_is_a_missing_service(http: httpx.Client, robot_bus: Bus) -> None:
    publisher = robot_bus.publisher(STATUS, robot="r2")

    def known() -> bool:
        publisher.put(MissionStatus(robot="r2"))
        return http.get("/api/robots/r2").status_code == 200

    assert wait_until(known, WAIT_S)
    answer = http.post("/api/robots/r2/missions/pause")
    assert answer.status_code == 503
    assert answer.headers["retry-after"] == "1"
    assert answer.json()["service"] == "planner"


def test_missions_are_counted(http: httpx.Client) -> None:
    http.post("/api/robots/r1/missions/pause")
    assert 'topnav_gateway_missions_total{action="pause",outcome="accepted"}' in http.get("/metrics").text


def test_the_default_robot_is_named_in_the_settings() -> None:
    assert GatewaySettings().robot == "r1"
