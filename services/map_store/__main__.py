"""`python -m services.map_store`: the maps, over the bus and over REST."""

import logging
import time
from threading import Event

from services.map_store.api import create_app
from services.map_store.database import Database
from services.map_store.missions import MissionStore
from services.map_store.server import serve
from services.map_store.service import Deltas, run
from services.map_store.settings import MapStoreSettings
from services.map_store.store import MapStore
from shared.bus import Bus
from shared.lifecycle import run_service

log = logging.getLogger(__name__)

NAME = "map_store"


def main() -> None:
    """Run until a signal comes."""
    settings = MapStoreSettings.from_environment()

    def loop(bus: Bus, stop: Event) -> None:
        database = Database(settings.database_url)
        deltas, ready = Deltas(bus), Event()
        store = MapStore(database, time.time_ns, deltas.push)

        def announce() -> None:
            ready.set()
            bus.announce(NAME)

        app = create_app(store, settings.token.get_secret_value(), settings.max_archive_bytes, ready.is_set)
        try:
            with serve(app, settings.host, settings.port):
                run(bus, stop, store, MissionStore(database), deltas, announce)
        finally:
            database.close()

    run_service(NAME, settings, loop)


if __name__ == "__main__":
    main()
