"""The tests of the store that do not look into a SQLite file, on a real PostgreSQL server."""

from collections.abc import Iterator

import pytest

from services.map_store.storage.database import Database
from tests.postgres import PostgresServer
from tests.unit.services.map_store import conftest, test_damage, test_marks, test_routes, test_store
from tests.unit.services.map_store.api import test_history_api
from tests.unit.services.map_store.history import test_revisions
from tests.unit.services.map_store.integrity import test_repair
from tests.unit.services.map_store.storage import test_answers, test_missions
from tests.unit.services.map_store.tasks import test_queue, test_timetable

BORROWED = {
    conftest: ("told", "database", "store", "client"),
    test_answers: ("pair",),
    test_damage: ("two",),
    test_history_api: (),
    test_marks: ("marked",),
    test_missions: (),
    test_routes: ("taught",),
    test_queue: ("desk",),
    test_timetable: ("times",),
    test_revisions: ("lived",),
    test_repair: ("chain",),
    test_store: (),
}
"""Fixtures by module; of tests all are taken but these."""
FILE_ONLY = frozenset(
    {
        "test_a_description_that_is_no_text_any_more_is_refused",
        "test_a_file_with_more_than_damaged_indexes_is_left_alone",
        "test_a_full_disk_refuses_writes_and_goes_on_reading",
        "test_a_reference_that_is_no_text_any_more_does_not_end_a_check",
        "test_damaged_indexes_are_built_anew",
        "test_nothing_is_written_to_a_file_that_is_damaged_but_what_is_whole_is_read",
        "test_tables_that_are_described_otherwise_are_refused",
    }
)


@pytest.fixture
def database_url(postgres: PostgresServer) -> str:
    """An empty part of a database on the server."""
    return postgres.new_schema()


@pytest.fixture(autouse=True)
def _all_closed(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Close what a test opened a second time: the driver complains about connections that are forgotten."""
    opened: list[Database] = []
    make = Database.__init__

    def remember(self: Database, url: str) -> None:
        make(self, url)
        opened.append(self)

    monkeypatch.setattr(Database, "__init__", remember)
    yield
    for database in opened:
        database.close()


for _module, _fixtures in BORROWED.items():
    _tests = (name for name in vars(_module) if name.startswith("test_") and name not in FILE_ONLY)
    globals().update({name: vars(_module)[name] for name in (*_fixtures, *_tests)})
