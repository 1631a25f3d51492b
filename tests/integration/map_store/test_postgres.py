"""Map stores on a real PostgreSQL server: two of them on one database, and a server that is killed."""

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import httpx
import pytest
import zenoh
from sqlalchemy.exc import DBAPIError

from services.map_store.errors import ConflictError, InvalidError, UnavailableError
from services.map_store.integrity.backup import file_of
from services.map_store.storage import engines
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import AddNode, MapDelta, MapReply, MapRequest
from shared.queries import QueryError, RefusedError
from shared.topics import MAP, MAP_DELTA, MAP_READ
from shared.transport.router_config import router_config
from tests.integration.map_store.conftest import START_S, Process
from tests.postgres import PostgresServer
from tests.unit.services.map_store.conftest import add

ANSWER_S = 30.0


@pytest.fixture
def url(postgres: PostgresServer) -> str:
    """An empty part of a database on the server."""
    return postgres.new_schema()


@pytest.fixture
def opened(url: str) -> Iterator[Callable[[], MapStore]]:
    """Call it for one more map store on the same database."""
    with ExitStack() as stack:

        def another() -> MapStore:
            database = Database(url)
            stack.callback(database.close)
            return MapStore(database, lambda: 1, lambda _: None)

        yield another


@pytest.fixture
def launch(
    repository: Path, tmp_path: Path, url: str, free_port: Callable[[], int]
) -> Iterator[Callable[..., Process]]:
    """Call it with a router's endpoint for one more map store process on the same database."""
    started: list[Process] = []

    def start(endpoint: str, database_url: str = url) -> Process:
        process = Process(
            repository, tmp_path, endpoint, free_port(), database_url=database_url, patient=True
        )
        process.start()
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()


def ask(bus: Bus, **fields: object) -> MapReply:
    return bus.ask(MAP, MapRequest(**fields), ANSWER_S, map="flat")


def alive(bus: Bus, number: int) -> None:
    assert wait_until(lambda: len(bus.alive("map_store")) == number, START_S)


def in_two_threads(work: Callable[[int], None]) -> None:
    threads = [threading.Thread(target=work, args=(number,)) for number in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_two_stores_that_start_at_once_make_the_tables_once(opened: Callable[[], MapStore]) -> None:
    stores: list[MapStore] = []
    in_two_threads(lambda _: stores.append(opened()))
    stores[0].create("flat")
    assert [record.name for record in stores[1].summaries()] == ["flat"]


def test_of_two_writers_with_the_same_base_one_wins_and_both_read_the_same(
    opened: Callable[[], MapStore],
) -> None:
    stores = (opened(), opened())
    stores[0].create("flat")
    for base in range(5):
        told: list[str] = []

        def write(which: int, base: int = base, told: list[str] = told) -> None:
            try:
                stores[which].transact("flat", [add(10 * base + which)], base_revision=base)
                told.append("won")
            except ConflictError as error:
                told.append(str(error))

        in_two_threads(write)
        assert sorted(told) == [
            f"map 'flat' is at revision {base + 1}, not {base}; read it again and decide anew",
            "won",
        ]
        assert stores[0].graph("flat") == stores[1].graph("flat")
    assert stores[0].graph("flat")[0] == 5


def test_no_write_of_two_stores_is_lost_and_epochs_are_given_once(opened: Callable[[], MapStore]) -> None:
    stores = (opened(), opened())
    stores[0].create("flat")
    epochs: list[int] = []

    def work(which: int) -> None:
        missions = MissionStore(stores[which].database)
        for number in range(20):
            stores[which].transact("flat", [add(100 * which + number)])
            epochs.append(missions.claim("r1").epoch)

    in_two_threads(work)
    for store in stores:
        revision, graph = store.graph("flat")
        assert (revision, len(graph.nodes)) == (40, 40)
    assert sorted(epochs) == list(range(1, 41))
    assert [entry.revision for entry in stores[0].revisions("flat", 99, 99)] == list(range(40, 0, -1))


def test_a_reader_sees_one_moment_while_others_write(opened: Callable[[], MapStore]) -> None:
    stores = (opened(), opened())
    stores[0].create("flat")
    with stores[1].database.read() as connection:
        before = connection.exec_driver_sql("SELECT revision FROM maps").scalar_one()
        stores[0].transact("flat", [add(0)])
        assert connection.exec_driver_sql("SELECT revision FROM maps").scalar_one() == before == 0


def test_a_store_that_hangs_in_a_transaction_does_not_stop_the_others_for_ever(
    url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engines, "BUSY_TIMEOUT_S", 0.5)
    monkeypatch.setattr(engines, "HUNG_AFTER_S", 6)  # longer than this thread may stand still before `create`
    hung, other = Database(url), Database(url)
    store = MapStore(other, lambda: 1, lambda _: None)
    try:
        with suppress(DBAPIError), hung._writer.connect() as connection:
            connection.begin()  # and then says nothing, with the writers' lock in its hand
            with pytest.raises(UnavailableError, match="another map store writes since"):
                store.create("flat")
            assert wait_until(lambda: created(store), ANSWER_S)
        with hung.read() as connection:
            assert connection.exec_driver_sql("SELECT name FROM maps").scalars().all() == ["flat"]
        MapStore(hung, lambda: 1, lambda _: None).create("house")
    finally:
        hung.close()
        other.close()


def created(store: MapStore) -> bool:
    try:
        store.create("flat")
    except UnavailableError:
        return False
    return True


def test_two_processes_on_one_bus_answer_each_question_once_and_followers_hear_both(
    launch: Callable[..., Process], router_endpoint: str
) -> None:
    with open_bus(router_endpoint) as bus:
        processes = [launch(router_endpoint) for _ in range(2)]
        alive(bus, 2)
        inbox = bus.subscribe(MAP_DELTA, map="flat")
        ask(bus, action="create")
        for number in range(10):
            assert ask(bus, action="transact", operations=(add(number),)).revision == number + 1
        # Over REST each process can be asked for itself: undo is a write of that process.
        rest = [httpx.Client(base_url=p.url, trust_env=False, timeout=ANSWER_S) for p in processes]
        for index, client in enumerate(rest):
            assert client.post("/maps/flat/undo").json()["revision"] == 11 + index
            client.close()
        deltas: list[MapDelta] = []
        assert wait_until(lambda: len(deltas.extend(inbox.take_all()) or deltas) >= 13, ANSWER_S)
        assert sorted(delta.revision for delta in deltas) == list(range(13))
        assert len(bus.ask(MAP_READ, MapRequest(action="read"), ANSWER_S, map="flat").nodes) == 8

        processes[0].kill()
        alive(bus, 1)
        assert ask(bus, action="transact", operations=(add(50),)).revision == 13


def test_two_processes_on_two_buses_share_a_map_and_one_of_two_equal_bases_wins(
    launch: Callable[..., Process], free_port: Callable[[], int]
) -> None:
    with ExitStack() as stack:
        endpoints = [f"tcp/127.0.0.1:{free_port()}" for _ in range(2)]
        for endpoint in endpoints:
            stack.enter_context(zenoh.open(router_config(endpoint)))
            launch(endpoint)
        buses = [stack.enter_context(open_bus(endpoint)) for endpoint in endpoints]
        for bus in buses:
            alive(bus, 1)
        ask(buses[0], action="create")
        told: list[object] = []

        def write(which: int) -> None:
            operations: tuple[AddNode, ...] = (add(which),)
            try:
                told.append(
                    ask(buses[which], action="transact", operations=operations, base_revision=0).revision
                )
            except RefusedError as error:
                told.append(str(error))

        in_two_threads(write)
        assert sorted(map(str, told)) == [
            "1",
            "map 'flat' is at revision 1, not 0; read it again and decide anew",
        ]
        first, second = (ask(bus, action="read") for bus in buses)
        assert (first.revision, first.nodes) == (second.revision, second.nodes)


def test_a_server_that_is_killed_costs_no_acknowledged_write_and_the_store_goes_on_by_itself(
    launch: Callable[..., Process], router_endpoint: str
) -> None:
    server = PostgresServer(durable=True)
    try:
        server.start()
        url = server.new_schema()
        with open_bus(router_endpoint) as bus:
            process = launch(router_endpoint, url)
            alive(bus, 1)
            ask(bus, action="create")
            for number in range(5):
                ask(bus, action="transact", operations=(add(number),))
            server.stop()
            server.start()  # while nobody asks: no question meets a connection that is gone
            assert ask(bus, action="read").revision == 5
            assert ask(bus, action="transact", operations=(add(5),)).revision == 6
            server.stop()
            with pytest.raises(RefusedError, match="database: OperationalError"):
                ask(bus, action="transact", operations=(add(6),))
            with pytest.raises(QueryError):
                ask(bus, action="read")
            server.start()
            read = ask(bus, action="read")
            assert (read.revision, [node.node_id for node in read.nodes]) == (6, list(range(6)))
            assert ask(bus, action="transact", operations=(add(6),)).revision == 7
            assert process.child is not None
            assert process.child.poll() is None
            check = httpx.get(f"{process.url}/check", trust_env=False, timeout=ANSWER_S)
            assert check.json() == {"damage": []}
    finally:
        server.close()


def test_without_a_server_the_store_ends_with_a_line_that_keeps_the_password(
    launch: Callable[..., Process], router_endpoint: str, capfd: pytest.CaptureFixture[str]
) -> None:
    process = launch(router_endpoint, "postgresql://topnav:s3cret@127.0.0.1:1/maps")
    assert process.child is not None
    assert process.child.wait(START_S) == 1
    told = capfd.readouterr().err
    assert "postgresql+psycopg://topnav:***@127.0.0.1:1/maps: database: OperationalError" in told
    assert "s3cret" not in told
    assert "Traceback" not in told


def test_a_copy_of_a_servers_database_is_left_to_its_own_tools() -> None:
    with pytest.raises(InvalidError, match=r"only a SQLite file .* got postgresql.*@db/maps; .*pg_dump"):
        file_of("postgresql://topnav:s3cret@db/maps")
