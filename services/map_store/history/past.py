"""Older revisions of a map, compared. No old graph is kept: the history leads back from the newest."""

from services.map_store.errors import MissingError
from services.map_store.history import revisions as history
from services.map_store.history.comparison import Comparison, compare, rewind
from services.map_store.storage import catalogue
from services.map_store.storage.database import Database
from services.map_store.storage.graphs import Graphs


class Past:
    """Reads the histories of `database`."""

    def __init__(self, database: Database, graphs: Graphs) -> None:
        self._database, self._graphs = database, graphs

    def compare(self, name: str, start: int, end: int | None) -> tuple[int, Comparison]:
        """What leads from revision `start` to `end` (None = the newest), whichever is older.

        Returns:
            The number of the end, and the comparison.

        Raises:
            MissingError: no such map or revision.
            CorruptError: a revision on the way back is damaged.
        """
        with self._database.read() as connection:
            found = catalogue.find(connection, name)
            end = found.revision if end is None else end
            for revision in (start, end):
                _check_revision(name, revision, found.revision)
            newer, older = max(start, end), min(start, end)
            newest = self._graphs.get(connection, found)
            after = rewind(newest, history.inverses(connection, found.map_id, found.revision, newer))
            before = rewind(after, history.inverses(connection, found.map_id, newer, older))
        return end, compare(before, after) if start <= end else compare(after, before)


def _check_revision(name: str, revision: int, newest: int) -> None:
    if not 0 <= revision <= newest:
        raise MissingError(f"map {name!r}: revision {revision} does not exist; revisions: 0 to {newest}")
