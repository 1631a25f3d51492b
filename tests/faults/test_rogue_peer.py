"""Case 21: who has a stolen certificate can do what its owner could, and nothing more.

Real processes: router with access rules, map store and drive. tests/faults/test_access_table.py tries every
stream; here is what a thief would try.
"""

import time
from itertools import count

import httpx
import pytest
import zenoh

from services.launcher.client.maps import store_client
from services.launcher.processes.free_ports import free_ports
from shared.access.credentials import credentials_in
from shared.bus import wait_until
from shared.messages.drive import Heading
from shared.messages.estop import EStopRequest
from shared.messages.maps import MapDelta, MapRequest
from shared.messages.sensors import Ranges
from shared.queries import AbsentError, RefusedError
from shared.topics import ESTOP, ESTOP_STATE, HEADING, MAP, MAP_DELTA, MAP_READ, RANGES, VELOCITY
from shared.transport.session_config import client_config
from shared.wire import encode
from tests.faults.secured import SecuredBus
from tests.unit.services.map_store.conftest import add

pytestmark = [pytest.mark.timeout(600), pytest.mark.usefixtures("patient_sessions")]

SOON_S = 30.0
WHILE_S = 0.6
"""Longer than a command lives."""
FLAT = "flat"
SEQUENCE = count(1)


@pytest.fixture(scope="module")
def secured(tmp_path_factory, repository):
    with SecuredBus(tmp_path_factory.mktemp("secured"), repository, *free_ports(2)) as bus:
        bus.start_map_store()
        bus.start_drive()
        write(bus.bus("planner"), action="create")
        write(bus.bus("planner"), action="transact", operations=(add(0),))
        yield bus


def write(bus, query=MAP, **fields):
    return bus.ask(query, MapRequest(**fields), SOON_S, map=FLAT)


def settle(bus):
    """Wait until the router has handled all that this session sent: its answer comes after."""
    bus.alive("router", timeout_s=SOON_S)


class Robot:
    """The body of robot r1: says what it senses, hears commands; and its rightful planner."""

    def __init__(self, secured):
        body, planner = secured.bus("simulator"), secured.bus("planner")
        self._ranges = body.publisher(RANGES, robot="r1")
        self.commands, self.stopped = (body.subscribe(t, robot="r1") for t in (VELOCITY, ESTOP_STATE))
        self._headings = planner.publisher(HEADING, robot="r1")
        self.seq, self.newest_radps = 0, 0.0

    def see(self):
        self.seq, angles = next(SEQUENCE), tuple(k * 0.5 for k in range(12))
        self._ranges.put(
            Ranges(
                seq=self.seq, stamp_ns=time.time_ns(), robot="r1", angles_rad=angles,
                distances_m=(4.0,) * 12, max_range_m=4.0,
            )
        )  # fmt: skip

    def wish(self):
        self._headings.put(heading(self.seq))

    def speeds(self, during_s, act):
        """Wheel speeds of all commands of a while in which it senses and `act` is done again and again."""
        deadline_s, came = time.monotonic() + during_s, []
        while time.monotonic() < deadline_s:
            self.see()
            act()
            time.sleep(0.03)
            came += [command.speed_mps for command in self.commands.take_all()]
        self.newest_radps = came[-1] if came else self.newest_radps
        return came

    def drives(self, act):
        return wait_until(lambda: any(self.speeds(0.1, act)), SOON_S)

    def stands(self, act):
        """Whether drive tells the wheels to stand and then nothing else: silent it may also be held up."""
        return wait_until(lambda: not any(self.speeds(0.3, act)) and not self.newest_radps, SOON_S)


def heading(seq, epoch=1):
    return Heading(seq=seq, stamp_ns=time.time_ns(), robot="r1", epoch=epoch, heading_rad=0.5)


@pytest.fixture(scope="module")
def robot(secured):
    return Robot(secured)


@pytest.mark.parametrize("thief", ["viewer", "recorder", "gateway", "features", "map_store"])
def test_a_stolen_certificate_does_not_move_the_robot(thief, secured, robot):
    session = zenoh.open(client_config(secured.endpoint, credentials_in(secured.certs / thief)))

    def attack():
        for key in (HEADING.key(robot="r1"), "topnav/*/heading", "topnav/**"):
            session.put(key, encode(heading(robot.seq, epoch=9)))
        session.put(VELOCITY.key(robot="r1"), b"\xff")

    try:
        assert robot.drives(robot.wish), "the planner can"
        assert robot.stands(lambda: None)
        assert not any(robot.speeds(WHILE_S, attack))
        assert robot.drives(robot.wish), "and the robot still hears its planner, whose epoch is lower"
        assert secured.bus("simulator").counters.snapshot().get("malformed", 0) == 0
    finally:
        session.close()
        robot.stands(lambda: None)


def test_a_planners_certificate_does_not_command_the_wheels(secured, robot):
    publisher = secured.bus("planner").publisher(VELOCITY, robot="r1")
    assert robot.stands(lambda: None)
    publisher.put_bytes(b"\xff")
    settle(secured.bus("planner"))
    robot.speeds(0.2, lambda: None)
    assert secured.bus("simulator").counters.snapshot().get("malformed", 0) == 0


def test_a_viewers_certificate_does_not_change_a_map(secured):
    viewer, planner = secured.bus("viewer"), secured.bus("planner")
    before = write(planner, action="read")
    deltas = planner.subscribe(MAP_DELTA, map=FLAT)
    recovered = []

    def complete():
        recovered.extend(delta.revision for delta in deltas.take_all())
        return before.revision in recovered

    assert wait_until(complete, SOON_S), "what was written before is recovered"
    for query in (MAP, MAP_READ):
        for fields in ({"action": "transact", "operations": (add(7),)}, {"action": "read"}):
            with pytest.raises(AbsentError):
                write(viewer, query, **fields)
    forged = MapDelta(map=FLAT, revision=99, reset=True)
    for key in (MAP_DELTA.key(map=FLAT), MAP_DELTA.key(map=FLAT) + "/@adv/pub/0/0/_", "topnav/maps/**"):
        viewer._session.put(key, encode(forged))
    settle(viewer)
    with pytest.raises(RefusedError):  # an answer of the map store: what was sent before has arrived by now
        write(planner, action="create")
    assert deltas.take_all() == []
    assert write(planner, action="read") == before


def test_a_features_certificate_reads_maps_and_writes_none(secured):
    features = secured.bus("features")
    assert [one.node_id for one in write(features, MAP_READ, action="read_features").features] == [0]
    with pytest.raises(RefusedError, match="this key only reads"):
        write(features, MAP_READ, action="transact", operations=(add(7),))
    with pytest.raises(AbsentError):
        write(features, action="transact", operations=(add(7),))


def test_a_viewer_follows_maps_and_the_robot(secured, robot):
    viewer = secured.bus("viewer")
    deltas, commands = viewer.subscribe(MAP_DELTA, map=FLAT), viewer.subscribe(VELOCITY, robot="r1")
    assert wait_until(lambda: any(delta.revision == 1 for delta in deltas.take_all()), SOON_S)
    assert wait_until(lambda: robot.drives(robot.wish) and commands.take() is not None, SOON_S)
    assert robot.stands(lambda: None)


def test_the_emergency_stop_is_for_people_and_not_for_watchers(secured, robot):
    def ask(holder, action):
        return secured.bus(holder).ask(ESTOP, EStopRequest(action=action, who="anna"), SOON_S, robot="r1")

    for holder in ("viewer", "recorder", "features", "planner"):
        with pytest.raises(AbsentError):
            ask(holder, "engage")
    assert not ask("gateway", "status").engaged
    assert ask("operator", "engage").engaged
    try:
        with pytest.raises(AbsentError):
            ask("viewer", "clear")
        robot.speeds(0.2, robot.wish)  # the first may have been under way
        assert not any(robot.speeds(WHILE_S, robot.wish))
        secured.bus("viewer")._session.put(ESTOP_STATE.key(robot="r1"), b"\xff")
        settle(secured.bus("viewer"))
    finally:
        assert not ask("gateway", "clear").engaged
    assert robot.drives(robot.wish)
    assert robot.stands(lambda: None)
    assert secured.bus("simulator").counters.snapshot().get("malformed", 0) == 0


def test_rest_is_for_those_who_may_write_maps(secured):
    def client(holder):
        return store_client(secured.rest_url, secured.certs / holder)

    for holder in ("gateway", "operator"):
        with client(holder) as rest:
            assert [entry["name"] for entry in rest.get("/maps").raise_for_status().json()] == [FLAT]
    for holder in ("viewer", "planner", "drive"):
        with client(holder) as rest, pytest.raises(httpx.TransportError):
            rest.delete(f"/maps/{FLAT}")
    uncertified = httpx.Client(base_url=secured.rest_url, verify=False, trust_env=False)
    with uncertified as rest, pytest.raises(httpx.TransportError):
        rest.get("/maps")
    assert write(secured.bus("planner"), action="read").revision == 1
