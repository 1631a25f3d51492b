"""topnav's missions for ROS: a goal, its start, reports, the end, and the emergency stop."""

import json
import threading

import numpy as np
import pytest

from services.ros.missions import PICTURE, STRING, TRIGGER, MissionDesk
from services.ros.robot_file import WireChoice
from services.ros.wires.opening import Interpreter, open_wire
from shared.bus import open_bus, wait_until
from shared.estop.sides import EStopServer
from shared.messages.missions import MissionStatus
from shared.topics import EXTRACT, MISSION
from tests.contract.samples import features
from tests.integration.ros.conftest import SOON_S
from tests.ros_messages import CODEC, jpeg, stamped


class Topnav:
    """Planner and feature service, as far as a mission asks them."""

    def __init__(self, bus):
        self.asked, self._bus = [], bus
        self._missions, self._extracts = bus.requests(MISSION, robot="r1"), bus.requests(EXTRACT)

    def step(self):
        while (request := self._missions.take()) is not None:
            self.asked.append(request.message)
            if request.message.action == "pause":
                request.refuse("nothing to pause")
            else:
                request.reply(MissionStatus(robot="r1", mission_id="m1", action="explore", state="running"))
        while (request := self._extracts.take()) is not None:
            self.asked.append(request.message)
            request.reply(features())


@pytest.fixture
def ros(router_endpoint):
    """A node of somebody in ROS, and ours."""
    choice = WireChoice(kind="bridge", endpoint=router_endpoint)
    ours, theirs = (open_wire(choice, CODEC, node, Interpreter("python3")) for node in ("topnav", "person"))
    yield ours, theirs
    theirs.close()
    ours.close()


@pytest.fixture
def desk(ros, router_endpoint):
    stood = threading.Event()
    with open_bus(router_endpoint) as bus:
        made = MissionDesk(bus, CODEC, "r1", stood.set)
        made.open(ros[0], "/topnav")
        made.stood = stood
        yield made
        made.close()


@pytest.fixture
def topnav(router_endpoint):
    with open_bus(router_endpoint) as bus:
        yield Topnav(bus)


class Desk:
    """What somebody in ROS does with it."""

    def __init__(self, desk, topnav):
        self.desk, self.topnav = desk, topnav

    def goal(self, text):
        self.desk._keep_goal(CODEC.encode(STRING, CODEC.make(STRING, data=text)), 0.0)

    def picture(self):
        message = stamped(PICTURE, 0.0)
        message.data = np.frombuffer(jpeg(), np.uint8)
        self.desk._keep_picture(CODEC.encode(PICTURE, message), 0.0)

    def call(self, name, step=None):
        """Answer of a service: whether it succeeded, and what it says."""
        answers = []
        self.desk._asked(name, b"", answers.append)

        def answered():
            (step or self.topnav.step)()
            return bool(answers)

        assert wait_until(answered, SOON_S)
        answer = CODEC.decode(f"{TRIGGER}_Response", answers[0])
        return answer.success, answer.message


@pytest.fixture
def person(desk, topnav):
    return Desk(desk, topnav)


def test_a_goal_is_started_with_its_picture_and_its_parameters(person, topnav):
    person.goal(json.dumps({"action": "goto", "map": "flat", "parameters": {"patience": 3}}))
    person.picture()
    assert person.call("start") == (True, "m1: explore running")
    extract, mission = topnav.asked
    assert extract.frame.encoding == "jpeg"
    assert (mission.action, mission.map, mission.parameters) == ("goto", "flat", {"patience": 3})
    assert mission.goal is not None


@pytest.mark.parametrize(
    ("goal", "named"),
    [
        ("", "no goal: publish one first"),
        ("{", "the goal is not JSON"),
        ("[" * 50_000, "the goal is not JSON"),
        ("[1]", "a goal is a JSON object with some of action"),
        ('{"action": "explore", "colour": 1}', "a goal is a JSON object with some of action"),
        ('{"action": "explore", "max_steps": 0}', "goal: max_steps"),
        ('{"map": "flat"}', "goal: action"),
        ("x" * 70_000, "no goal"),
    ],
)
def test_a_goal_that_is_none_is_refused_with_the_reason(person, topnav, goal, named):
    person.goal(goal)
    success, said = person.call("start")
    assert not success
    assert named in said
    assert topnav.asked == []


def test_a_refusal_of_the_planner_is_the_answer(person):
    success, said = person.call("pause")
    assert not success
    assert "nothing to pause" in said


def test_stop_stands_at_once_and_engages_the_emergency_stop(person, desk, router_endpoint, tmp_path):
    with open_bus(router_endpoint) as bus:
        server, clock = EStopServer(bus, "r1", tmp_path), iter(range(1_000_000))
        success, said = person.call("stop", step=lambda: server.step(float(next(clock))))
        assert success, said
        assert "until a person clears it" in said
        assert (server.state.engaged, server.state.who) == (True, "ros")
    assert desk.stood.is_set()


def test_reports_come_while_it_runs_and_once_at_its_end(ros, desk):
    came = {"feedback": [], "result": []}
    for name, texts in came.items():
        ros[1].subscribe(
            f"/topnav/{name}",
            STRING,
            lambda payload, _at_s, texts=texts: texts.append(json.loads(CODEC.decode(STRING, payload).data)),
        )
    running = MissionStatus(robot="r1", mission_id="m1", action="explore", state="running")
    moments = iter(range(1_000_000))

    def reported():
        desk.tell(running, float(next(moments)))
        return bool(came["feedback"])

    assert wait_until(reported, SOON_S)
    assert came["feedback"][0]["state"] == "running"
    done = running.model_copy(update={"state": "succeeded"})
    for _ in range(3):
        desk.tell(done, float(next(moments)))
    assert wait_until(lambda: bool(came["result"]), SOON_S)
    assert [status["state"] for status in came["result"]] == ["succeeded"]
