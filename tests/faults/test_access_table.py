"""The access table on a real router: every role tries every stream, and only what is granted gets through.

What must not arrive is sent before something that must, and its sender has had an answer of the router since.
"""

import datetime as dt
import threading
import time
from contextlib import ExitStack

import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.access.credentials import credentials_in
from shared.access.rules import QUESTIONS, STREAMS, Role
from shared.bus import wait_until
from shared.certificates.holders import Holder, another_robot
from shared.certificates.issuing import make
from shared.transport.keys import alive_key, robot_key
from shared.transport.session_config import client_config
from tests.faults.secured import SecuredBus

pytestmark = [pytest.mark.timeout(600), pytest.mark.usefixtures("patient_sessions")]

ROLES = [role for role in Role if role is not Role.ROUTER]
SOON_S = 30.0
LATE_S = 0.3


@pytest.fixture(scope="module")
def sessions(tmp_path_factory, repository):
    """One session per role of robot r1, and of robot r2's services under names such as "drive.r2"."""
    with SecuredBus(tmp_path_factory.mktemp("table"), repository, *free_ports(2), robots="r1,r2") as bus:
        holders = [Holder("robot", Role.ROBOT, "r1"), *another_robot("r2")]
        make(bus.certs, holders, dt.datetime.now(dt.UTC))
        names = [role.value for role in ROLES] + [holder.name for holder in another_robot("r2")]
        configs = {n: client_config(bus.endpoint, credentials_in(bus.certs / n)) for n in names}
        with ExitStack() as stack:
            yield {name: stack.enter_context(zenoh.open(config)) for name, config in configs.items()}


def settle(session):
    """Wait until the router has handled all that this session sent: its answer comes after."""
    list(session.liveliness().get(alive_key("router", "*"), timeout=SOON_S))


def named(grantees, stream):
    """Sessions that the table means: those of r1, and of r2 where the key is not one robot's."""
    ours = {role.value for role in grantees}
    of_one = "{robot}" in stream.template or "{queue}" in stream.template
    return ours if of_one else ours | {f"{r.value}.r2" for r in grantees if has_r2(r)}


def has_r2(role):
    return role in [holder.role for holder in another_robot("r2")]


@pytest.mark.parametrize("stream", STREAMS, ids=lambda stream: stream.template)
def test_only_who_speaks_is_heard_and_only_by_who_may_hear(stream, sessions):
    grant, key = STREAMS[stream], stream.template.format(robot="r1", queue="r1", map="flat")
    heard = {name: [] for name in sessions}
    listening = [
        session.declare_subscriber(k, lambda sample, name=name: heard[name].append(bytes(sample.payload)))
        for name, session in sessions.items()
        for k in (key, "topnav/**", "**")
    ]
    for session in sessions.values():
        settle(session)
    for name, session in sessions.items():
        if name not in named(grant.speakers, stream):
            for k in (key, "topnav/**", "topnav/*/*", "**"):
                session.put(k, name.encode())
            settle(session)
    for name in sorted(named(grant.speakers, stream)):
        sessions[name].put(key, b"last of " + name.encode())
    expected = {b"last of " + name.encode() for name in named(grant.speakers, stream)}
    hearers = named(grant.hearers, stream)
    try:
        assert wait_until(lambda: all(expected <= set(heard[name]) for name in hearers), SOON_S)
        time.sleep(LATE_S)
        # A session hears itself without the router; a role heard from its namesake would be another session.
        others = {name: {p for p in set(heard[name]) if name.encode() not in p.split()} for name in heard}
        for name, payloads in others.items():
            allowed = {p for p in expected if name.encode() not in p.split()} if name in hearers else set()
            assert payloads == allowed, name
    finally:
        for one in listening:
            one.undeclare()


@pytest.mark.parametrize("stream", STREAMS, ids=lambda stream: stream.template)
def test_a_publisher_hears_of_those_who_subscribe_later_to_all_robots(stream, sessions):
    """A client sends only what it knows that somebody wants; watchers want the streams of every robot."""
    grant = STREAMS[stream]
    watchers = [role.value for role in grant.hearers if not role.of_one_robot]
    for speaker in sorted(role.value for role in grant.speakers):
        publisher = sessions[speaker].declare_publisher(
            stream.template.format(robot="r1", queue="r1", map="flat")
        )
        settle(sessions[speaker])
        for name in watchers:
            arrived = threading.Event()
            key = stream.template.format(robot="*", queue="*", map="*")
            inbox = sessions[name].declare_subscriber(key, lambda _, arrived=arrived: arrived.set())

            def sent(publisher=publisher, arrived=arrived):
                publisher.put(b"here")
                return arrived.wait(0.05)

            assert wait_until(sent, SOON_S), f"{name} does not hear {speaker}"
            inbox.undeclare()
            settle(sessions[name])
        publisher.undeclare()


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.template)
def test_only_who_may_ask_is_answered_and_only_by_who_may_answer(question, sessions):
    grant, key = QUESTIONS[question], question.template.format(robot="r1", queue="r1", map="flat")
    declared = []
    for name, session in sessions.items():

        def answer(query, name=name):
            with query:
                query.reply(key, name.encode())

        declared.append(session.declare_queryable(key, answer))
    try:
        for session in sessions.values():
            settle(session)
        for name, session in sessions.items():
            everybody = {"target": zenoh.QueryTarget.ALL, "consolidation": zenoh.ConsolidationMode.NONE}
            replies = list(session.get(key, timeout=SOON_S, **everybody))
            found = {r.ok.payload.to_bytes().decode() for r in replies if r.ok is not None} - {name}
            assert found == (
                named(grant.speakers, question) if name in named(grant.hearers, question) else set()
            ), name
    finally:
        for one in declared:
            one.undeclare()


def test_nobody_is_alive_in_anothers_name(sessions):
    tokens = [
        session.liveliness().declare_token(key)
        for name, session in sessions.items()
        for key in (alive_key("drive", name.replace(".", "-")), robot_key("r1", name.replace(".", "-")))
    ]
    try:
        for session in sessions.values():
            settle(session)

        def alive(key):
            found = sessions["gateway"].liveliness().get(key, timeout=SOON_S)
            own = "/gateway"
            keys = {str(one.ok.key_expr) for one in found if one.ok is not None}
            return sorted(k.rpartition("/")[2] for k in keys if not k.endswith(own))

        assert alive(alive_key("drive", "*")) == ["drive", "drive-r2"]
        assert alive(robot_key("r1", "*")) == ["robot", "simulator"]
    finally:
        for token in tokens:
            token.undeclare()


def test_the_inside_of_the_router_is_nobodys_business(sessions):
    for name, session in sessions.items():
        found = [one for one in session.get("@/*/router/**", timeout=1.0) if one.ok is not None]
        assert found == [], name
