"""Driving by hand over HTTP: wishes reach the bus in order, bad ones are refused, too many as well."""

import httpx
import pytest

from services.gateway.http.rates import WISH_BURST
from shared.bus import Bus, wait_until
from shared.topics import MANUAL
from tests.integration.gateway.gateway_process import WAIT_S

PATH = "/api/robots/r1/drive"


def test_a_wish_reaches_the_robot_with_the_name_of_who_drives(http: httpx.Client, robot_bus: Bus) -> None:
    wishes, came = robot_bus.subscribe(MANUAL, robot="r1"), []

    def driven() -> bool:
        answer = http.post(PATH, json={"who": "anna", "forward_mps": 0.2, "turn_radps": -0.5})
        assert (answer.status_code, answer.json()) == (202, {"robot": "r1", "who": "anna"})
        came.extend(wishes.take_all())
        return len(came) > 1

    assert wait_until(driven, WAIT_S)
    newest = came[-1]
    assert (newest.who, newest.action, newest.ttl_ms) == ("anna", "drive", 400)
    assert (newest.forward_mps, newest.left_mps, newest.turn_radps) == (0.2, 0.0, -0.5)
    numbers = [wish.seq for wish in came]
    assert numbers == sorted(set(numbers))


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"who": ""},
        {"who": "anna", "forward_mps": 99},
        {"who": "anna", "ttl_ms": 60_000},
        {"who": "anna", "action": "fly"},
        {"who": "anna", "speed": 1},
    ],
)
def test_a_wish_that_makes_no_sense_is_refused_by_name(http: httpx.Client, body: dict[str, object]) -> None:
    answer = http.post(PATH, json=body)
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"


def test_a_robot_nobody_heard_of_is_named(http: httpx.Client) -> None:
    answer = http.post("/api/robots/stranger/drive", json={"who": "anna"})
    assert answer.status_code == 404
    assert "stranger" in answer.text


def test_wishes_have_a_limit_of_their_own(http: httpx.Client) -> None:
    answers = [http.post(PATH, json={"who": "anna"}).status_code for _ in range(4 * WISH_BURST)]
    assert answers[: WISH_BURST // 2] == [202] * (WISH_BURST // 2)
    assert 429 in answers
