"""The type that is sent is one that somebody hears."""

import pytest

from services.ros.base_link import chosen_type
from services.ros.robot_file import VelocityTopic
from services.ros.wires.wire import Endpoint
from tests.ros_messages import TWIST, TWIST_STAMPED

AUTO = VelocityTopic(topic="/cmd_vel")
ONLY_TWIST = VelocityTopic(topic="/cmd_vel", type=TWIST)


def subscribers(*kinds):
    return [Endpoint("/base", kind) for kind in kinds]


@pytest.mark.parametrize(
    ("spoken", "kinds", "chosen"),
    [
        (AUTO, [TWIST], TWIST),
        (AUTO, [TWIST_STAMPED], TWIST_STAMPED),
        (AUTO, [TWIST, TWIST_STAMPED], TWIST_STAMPED),
        (ONLY_TWIST, [TWIST, TWIST_STAMPED], TWIST),
    ],
)
def test_the_type_is_what_somebody_subscribes_to(spoken, kinds, chosen):
    assert chosen_type(spoken, subscribers(*kinds)) == (chosen, "")


def test_a_base_that_wants_another_type_is_named_with_both():
    kind, problem = chosen_type(ONLY_TWIST, subscribers(TWIST_STAMPED))
    assert kind is None
    assert problem == f"/cmd_vel: {TWIST} expected, but it is subscribed to by /base as {TWIST_STAMPED}"
    assert "as std_msgs/msg/String" in chosen_type(AUTO, subscribers("std_msgs/msg/String"))[1]


def test_nobody_who_hears_is_a_problem_though_a_type_that_is_sure_is_sent():
    assert chosen_type(AUTO, []) == (None, "/cmd_vel: nobody subscribes to it: is the driver of the base up?")
    assert chosen_type(ONLY_TWIST, [])[0] == TWIST
