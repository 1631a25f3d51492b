"""`python -m services.map_store`: the maps, over the bus and over REST."""

import logging
import sys
import time
from threading import Event

from services.map_store.api.app import create_app
from services.map_store.api.server import serve
from services.map_store.errors import MapError
from services.map_store.inspections.store import InspectionStore
from services.map_store.merging.merges import Merges
from services.map_store.service import Deltas, matcher, run
from services.map_store.settings import MapStoreSettings
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from services.map_store.tasks.queue import TaskStore
from shared.bus import Bus
from shared.lifecycle import run_service
from shared.web.origins import LOOPBACK_NAMES

log = logging.getLogger(__name__)

NAME = "map_store"


def main() -> None:
    """Run until a signal comes; exits with 2 and one line when the settings are wrong."""
    try:
        settings = MapStoreSettings.from_environment().with_kept_secret()
    except ValueError as error:
        sys.stderr.write(f"map_store: {error}\n")
        sys.exit(2)

    def loop(bus: Bus, stop: Event) -> None:
        try:
            database = Database(settings.database_url)
        except MapError as error:
            log.error("%s", error)
            sys.exit(1)
        deltas, ready = Deltas(bus), Event()
        store = MapStore(database, time.time_ns, deltas.push)
        visits = InspectionStore(database)
        merges = Merges(store, matcher(bus, settings.robot, settings.compute_timeout_s))

        def announce() -> None:
            ready.set()
            bus.announce(NAME)

        app = create_app(
            store,
            merges,
            visits,
            settings.token.get_secret_value(),
            settings.max_archive_bytes,
            ready.is_set,
            names=LOOPBACK_NAMES | {settings.host} if settings.loopback else None,
            guard_reading=not settings.loopback,
        )
        try:
            with serve(app, settings, stop):
                missions, tasks = MissionStore(database), TaskStore(database, time.time_ns)
                run(bus, stop, store, missions, tasks, visits, deltas, announce)
        finally:
            merges.close()
            database.close()

    run_service(NAME, settings, loop)


if __name__ == "__main__":
    main()
