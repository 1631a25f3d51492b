"""`python -m shared.router`: the Zenoh router that introduces the processes to each other."""

import logging
import os
import sys

import zenoh

from shared.bus import Bus
from shared.bus_config import router_config
from shared.lifecycle import configure_logging, stop_on_signals

log = logging.getLogger(__name__)


def main() -> int:
    """Route until a signal comes; listens on TOPNAV_ROUTER_LISTEN."""
    listen = os.environ.get("TOPNAV_ROUTER_LISTEN", "tcp/127.0.0.1:7447")
    configure_logging("router", os.environ.get("TOPNAV_LOG_LEVEL", "INFO"))
    stop = stop_on_signals()
    try:
        bus = Bus(zenoh.open(router_config(listen)))
    except zenoh.ZError as error:
        log.error("cannot listen on %s (is another router running?): %s", listen, error)
        return 1
    try:
        bus.announce("router")
        log.info("listening on %s", listen)
        stop.wait()
    finally:
        bus.close()
    log.info("stopped")
    return 0


if __name__ == "__main__":
    sys.exit(main())
