"""The access table: every stream has owners, the code keeps to it, and it says what the security rests on."""

import ast
import re

import pytest

from shared import topics
from shared.access.rules import BODIES, PEOPLE, QUESTIONS, STREAMS, Role, robot_names
from shared.topics import QUERIES, TOPICS

FOLDERS = {
    "simulator": Role.SIMULATOR,
    "services/signs": Role.SIGNS,
    "services/features": Role.FEATURES,
    "services/map_store": Role.MAP_STORE,
    "services/planner": Role.PLANNER,
    "services/drive": Role.DRIVE,
    "services/dispatch": Role.DISPATCH,
    "services/fleet": Role.FLEET,
    "services/gateway": Role.GATEWAY,
    "services/ros": Role.ROBOT,
    "services/launcher": Role.OPERATOR,
    "experiments": Role.OPERATOR,
}
# Many robots' simulator and planner, a robot's body with its truth, on buses of their own: none is secured.
IMPERSONATORS = {
    "experiments/scale/asking_robot.py",
    "experiments/ros_robot/body.py",
    "experiments/ros_robot/truth.py",
}
# The emergency stop is in shared code: drive holds the desk, a body follows.
SIDES = {"EStopServer": Role.DRIVE, "RobotEStop": Role.SIMULATOR}
CALLS = {
    "publisher": (STREAMS, "speakers"),
    "subscribe": (STREAMS, "hearers"),
    "requests": (QUESTIONS, "speakers"),
    "ask": (QUESTIONS, "hearers"),
}


def uses(tree: ast.AST) -> set[tuple[str, str]]:
    """Every (method of the bus, name of a stream) in a syntax tree."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CALLS:
            names = (argument.id for argument in node.args if isinstance(argument, ast.Name))
            found |= {(node.func.attr, name) for name in names if name.isupper() and hasattr(topics, name)}
    return found


def forbidden(role: Role, found: set[tuple[str, str]]) -> list[str]:
    """What of this the table does not allow."""
    wrong = []
    for method, name in sorted(found):
        table, side = CALLS[method]
        if role not in getattr(table[getattr(topics, name)], side):
            wrong.append(f"{role.value} {method} {name}")
    return wrong


def test_every_topic_and_question_has_somebody_on_each_side():
    assert set(STREAMS) == set(TOPICS)
    assert set(QUESTIONS) == set(QUERIES)
    for stream, grant in (STREAMS | QUESTIONS).items():
        assert grant.speakers, stream.template
        assert grant.hearers, stream.template


@pytest.mark.parametrize(("folder", "role"), FOLDERS.items())
def test_the_code_of_a_service_does_nothing_that_its_role_may_not(folder, role, repository):
    found = set()
    for path in sorted((repository / folder).rglob("*.py")):
        if path.relative_to(repository).as_posix() in IMPERSONATORS:
            continue
        found |= uses(ast.parse(path.read_text(encoding="utf-8")))
    assert found, f"no use of the bus found in {folder}"
    assert forbidden(role, found) == []


def test_both_sides_of_the_emergency_stop_keep_to_the_table(repository):
    tree = ast.parse((repository / "shared/estop/sides.py").read_text(encoding="utf-8"))
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    for name, role in SIDES.items():
        found = uses(classes[name])
        assert found, name
        assert forbidden(role, found) == []


def test_the_reader_would_notice_a_planner_that_commands():
    found = uses(ast.parse("self._x = bus.publisher(VELOCITY, robot=r)\nbus.subscribe(TRUTH, robot=r)"))
    assert forbidden(Role.PLANNER, found) == ["planner publisher VELOCITY", "planner subscribe TRUTH"]


def test_one_role_each_moves_the_robot_and_decides_where_to():
    assert STREAMS[topics.VELOCITY].speakers == {Role.DRIVE}
    assert STREAMS[topics.HEADING].speakers == {Role.PLANNER}
    assert STREAMS[topics.ESTOP_STATE].speakers == {Role.DRIVE}


def test_only_bodies_say_what_a_robot_senses_and_only_the_simulator_where_it_is():
    for stream in (topics.RANGES, topics.ROBOT_ESTOP_STATE):
        assert STREAMS[stream].speakers == set(BODIES)
    assert STREAMS[topics.FRAME].speakers == {*BODIES, Role.CAMERA}
    assert STREAMS[topics.TRUTH].speakers == {Role.SIMULATOR}


def test_nobody_who_decides_may_know_the_true_pose():
    assert not STREAMS[topics.TRUTH].hearers & {Role.PLANNER, Role.FEATURES, Role.DRIVE, Role.MAP_STORE}


def test_maps_are_written_by_the_planner_by_who_reads_signs_and_by_people_only():
    assert QUESTIONS[topics.MAP].hearers == {Role.PLANNER, Role.SIGNS, *PEOPLE}
    assert QUESTIONS[topics.MAP].speakers == QUESTIONS[topics.MAP_READ].speakers == {Role.MAP_STORE}


def test_viewer_and_recorder_say_nothing_and_ask_nothing():
    for grant in (*STREAMS.values(), *QUESTIONS.values()):
        assert not grant.speakers & {Role.VIEWER, Role.RECORDER}
    for grant in QUESTIONS.values():
        assert not grant.hearers & {Role.VIEWER, Role.RECORDER}


def test_the_live_view_says_nothing_reads_maps_and_does_not_know_the_true_pose():
    for grant in (*STREAMS.values(), *QUESTIONS.values()):
        assert Role.FOXGLOVE not in grant.speakers
    assert [query for query, grant in QUESTIONS.items() if Role.FOXGLOVE in grant.hearers] == [
        topics.MAP_READ
    ]
    assert Role.FOXGLOVE not in STREAMS[topics.TRUTH].hearers


def test_a_role_of_one_robot_carries_its_name():
    assert Role.DRIVE.common_name("r2") == "drive.r2"
    assert Role.MAP_STORE.common_name("r2") == "map_store"
    with pytest.raises(ValueError, match="a robot's name must match"):
        Role.DRIVE.common_name("r1.r2")


def test_robots_are_named_by_the_list_or_else_by_the_one():
    assert robot_names({"TOPNAV_ROBOTS": "r1, r2", "TOPNAV_ROBOT": "r9"}) == ("r1", "r2")
    assert robot_names({"TOPNAV_ROBOTS": "", "TOPNAV_ROBOT": "r9"}) == ("r9",)
    assert robot_names({}) == ("r1",)


@pytest.mark.parametrize("variable", ["TOPNAV_ROBOTS", "TOPNAV_ROBOT", "TOPNAV_FEATURES_ROBOTS"])
@pytest.mark.parametrize("name", ["*", "r1/**", "R1", "maps"])
def test_a_variable_that_names_no_robot_is_told(variable: str, name: str):
    with pytest.raises(ValueError, match=rf"^{variable}: a robot's name must .*; got '{re.escape(name)}'$"):
        robot_names({"TOPNAV_ROBOTS": "r1", variable: name})


def test_a_robot_has_one_name():
    with pytest.raises(ValueError, match=r"^TOPNAV_ROBOT: .*; got 'r1,r2'"):
        robot_names({"TOPNAV_ROBOT": "r1,r2"})
