"""Broken messages on the bus: counted or refused one by one, and nobody goes down."""

import json
import math

import msgpack
import numpy as np
import pytest
import zenoh

from shared.bus import wait_until
from shared.messages.drive import Heading, Velocity
from shared.messages.features import Features
from shared.messages.maps import DeleteNode, MapRequest
from shared.messages.matching import MatchRequest
from shared.messages.missions import MissionRequest
from shared.messages.sensors import Frame, Ranges
from shared.queries import RefusedError
from shared.topics import MAP, MATCH, MISSION
from shared.transport.session_config import peer_config
from shared.wire import encode
from tests.e2e.near_node import hiding_place_near_a_node

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]


def features(pipeline="other-pipeline"):
    arrays = {"lonlat_rad": np.zeros((1, 2), np.float32), "scores": np.zeros(1, np.float32)}
    return Features(robot="r1", pipeline=pipeline, descriptors=np.zeros((1, 4), np.uint8), **arrays)


def frame(**changes):
    return Frame(robot="r1", encoding="bgr8", width_px=2, height_px=1, data=bytes(6), **changes)


def altered(message, **changes):
    """The bytes of a message with some fields replaced, unchecked."""
    return msgpack.packb({**msgpack.unpackb(encode(message)), **changes})


HEADING = Heading(robot="r1")
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(1.0,) * 12, max_range_m=4.0)

STALE = MapRequest(action="transact", base_revision=10_000, operations=(DeleteNode(node_id=0),))

STREAMS = [
    pytest.param("frame", encode(frame())[:40], "features", "not msgpack", id="truncated frame"),
    pytest.param(
        "frame", altered(frame(), width_px=3), "features", "twice as wide", id="frame of wrong shape"
    ),
    pytest.param(
        "frame", encode(frame(seq=0, stamp_ns=1)), "features", "came after a newer", id="stale frame"
    ),
    pytest.param("features", encode(HEADING), "planner", "schema 'features.v1'", id="wrong schema"),
    pytest.param("heading", altered(HEADING, heading_rad=math.nan), "drive", "heading_rad", id="NaN heading"),
    pytest.param("heading", encode(HEADING), "drive", "old_epoch", id="heading of a replaced planner"),
    pytest.param(
        "ranges", altered(RANGES, distances_m=[1.0] * 11), "drive", "distances_m", id="11 distances"
    ),
    pytest.param("velocity", bytes(20_000), "simulator", "at most 10000 bytes", id="huge velocity"),
    pytest.param(
        "velocity",
        altered(Velocity(robot="r1"), forward_mps=1e9),
        "simulator",
        "forward_mps",
        id="velocity beyond all limits",
    ),
    pytest.param("velocity", b"\x81" * 5_000, "simulator", "velocity.v1", id="nested too deeply"),
]

QUESTIONS = [
    pytest.param(
        MATCH, MatchRequest(map="nowhere", features=features(), best_k=1), "nowhere", id="unknown map"
    ),
    pytest.param(
        MATCH, MatchRequest(map="small", features=features(), best_k=1), "pipeline", id="wrong pipeline"
    ),
    pytest.param(MISSION, MissionRequest(action="goto", map="small"), "goal", id="goto without a goal"),
    pytest.param(
        MISSION, MissionRequest(action="goto", map="nowhere", goal_node=0), "nowhere", id="mission in no map"
    ),
    pytest.param(MAP, STALE, "revision", id="transaction on a wrong revision"),
]


@pytest.fixture(scope="module")
def session(explored):
    with zenoh.open(peer_config(explored.stack.endpoint)) as opened:
        yield opened


@pytest.fixture(autouse=True)
def nobody_goes_down(explored):
    """Around every test: the same processes before and after."""
    before = {name: (s.pid, s.restarts) for name, s in explored.stack.launcher.status().items()}
    yield
    assert {n: (s.pid, s.restarts) for n, s in explored.stack.launcher.status().items()} == before


def warnings_of(explored, service):
    log = (explored.stack.launcher.logs / f"{service}.jsonl").read_bytes()
    whole = log[: log.rfind(b"\n") + 1].decode()  # the last line may still be under way
    lines = [json.loads(line) for line in whole.splitlines() if line.startswith("{")]
    return [line["text"] for line in lines if line["level"] == "WARNING"]


@pytest.mark.parametrize(("topic", "payload", "service", "text"), STREAMS)
def test_a_broken_message_is_counted_by_its_reader(explored, session, topic, payload, service, text):
    seen = len(warnings_of(explored, service))

    def counted():
        session.put(f"topnav/r1/{topic}", payload)  # a warning is logged at most once a second: try again
        return any(text in line for line in warnings_of(explored, service)[seen:])

    assert wait_until(counted, timeout_s=60.0, period_s=0.2), warnings_of(explored, service)[-3:]


@pytest.mark.parametrize(("query", "request_", "text"), QUESTIONS)
def test_a_question_that_cannot_be_answered_is_refused_with_the_reason(explored, query, request_, text):
    names = {"map": "small"} if query is MAP else {"robot": "r1"}
    with pytest.raises(RefusedError, match=text):
        explored.stack.bus.ask(query, request_, 60.0, **names)


def test_a_question_that_is_not_msgpack_is_refused(session):
    for key in ("topnav/r1/mission", "topnav/r1/match", "topnav/maps/small/graph", "topnav/r1/simulation"):
        (answer,) = answers_to_junk(session, key)
        assert b"malformed" in answer.err.payload.to_bytes(), key


def answers_to_junk(session, key):
    """All there are; the service is asked until this session has met it."""
    answers = []

    def heard():
        answers.extend(session.get(key, payload=b"\xc1\xc1", timeout=60.0))
        return bool(answers)

    assert wait_until(heard, 60.0), key
    return answers


def test_after_all_of_it_a_mission_still_succeeds(explored):
    game = explored.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(explored.result, explored.space, start)
    played = game.seek(start, hider, seed=2, max_steps=200)
    assert played.success, played.run.status.reason
