"""The hub: what is kept of each robot and who hears of it."""

import json

import pytest

from services.gateway.http.metrics import Metrics
from services.gateway.live.hub import Hub
from shared.messages.body import Battery, Imu
from shared.messages.drive import Heading
from shared.messages.estop import EStopState
from shared.messages.missions import Event, MissionStatus
from shared.messages.sensors import Frame


def hub(max_robots: int = 2) -> Hub:
    return Hub(Metrics(lambda: {}), max_robots)


def frame(seq: int) -> Frame:
    return Frame(seq=seq, robot="r1", encoding="jpeg", width_px=4, height_px=2, data=b"")


@pytest.mark.asyncio
async def test_who_joins_late_hears_what_is_known() -> None:
    mine = hub()
    mine.take([frame(1), frame(2), Heading(robot="r1"), MissionStatus(robot="r1", state="running")])
    mine.take([Event(robot="r1", kind="replan", reason=str(n)) for n in range(3)])
    mine.take_services({"planner": 1})
    outbox = mine.join("r1")
    assert outbox is not None
    heard = [json.loads(text) for text in await outbox.take()]
    assert [item["data"]["reason"] for item in heard if item["type"] == "event"] == ["0", "1", "2"]
    newest = {item["type"]: item["data"] for item in heard}
    assert newest["frame"]["seq"] == 2
    assert "data" not in newest["frame"]
    assert newest["status"]["state"] == "running"
    assert newest["services"] == {"planner": 1}


@pytest.mark.asyncio
async def test_who_joins_late_hears_of_an_emergency_stop_and_of_its_end() -> None:
    mine = hub()
    at = {"who": "anna", "why": "a child", "since_ns": 1_700_000_000_500_000_000}
    mine.take([EStopState(seq=1, robot="r1", engaged=True, **at)])
    outbox = mine.join("r1")
    assert outbox is not None
    heard = {item["type"]: item["data"] for item in map(json.loads, await outbox.take())}
    assert heard["estop"] == {
        "robot": "r1",
        "engaged": True,
        "who": "anna",
        "why": "a child",
        "since": "2023-11-14T22:13:20.500+00:00",
    }
    mine.take([EStopState(seq=2, robot="r1", engaged=False)])
    (news,) = map(json.loads, await outbox.take())
    assert (news["type"], news["data"]["engaged"], news["data"]["since"]) == ("estop", False, None)


@pytest.mark.asyncio
async def test_robots_do_not_hear_of_each_other() -> None:
    mine = hub()
    outbox = mine.join("r1")
    assert outbox is not None
    await outbox.take()
    mine.take([Event(robot="r2", kind="replan"), Event(robot="r1", kind="mine")])
    assert ["mine" in text for text in await outbox.take()] == [True]


def test_a_flood_of_robot_names_is_ignored_and_counted() -> None:
    metrics = Metrics(lambda: {})
    mine = Hub(metrics, 2)
    mine.take([Event(robot=f"r{n}", kind="x") for n in range(100)])
    assert len(mine.robots) == 2
    assert b"robots_ignored_total 98.0" in metrics.text()


def test_who_left_is_forgotten() -> None:
    mine = hub()
    outbox = mine.join("r1")
    assert outbox is not None
    mine.take([Heading(robot="r1")])
    mine.leave("r1", outbox)
    assert mine.robots["r1"].outboxes == set()


def test_names_that_only_followers_said_take_no_robots_place() -> None:
    mine = hub(max_robots=2)
    followed = [(name, mine.join(name)) for name in ("a", "b", "c")]
    mine.take([Heading(robot="r1"), Heading(robot="r2")])
    assert mine.knows("r1")
    assert mine.knows("r2")
    assert mine.join("d") is None, "there are as many robots as there may be"
    for name, outbox in followed:
        assert outbox is not None
        mine.leave(name, outbox)
    assert set(mine.robots) == {"r1", "r2"}


def test_a_body_that_speaks_fast_is_told_seldom_and_known_to_the_last(monkeypatch) -> None:
    now_s, told = 100.0, []
    monkeypatch.setattr("services.gateway.live.hub.time.monotonic", lambda: now_s)
    mine = hub()
    mine.take([frame(1)])
    outbox = mine.join("r1")
    assert outbox is not None
    monkeypatch.setattr(outbox, "offer_newest", lambda kind, _text: told.append(kind))
    for number in range(100):  # an IMU for a second
        now_s = 100.0 + 0.01 * number
        mine.take([Imu(seq=number, robot="r1"), *([Battery(robot="r1")] if number == 60 else [])])
    assert told == ["imu", "imu", "battery"]
    newest = mine.robots["r1"].imu
    assert newest is not None
    assert newest.seq == 99
