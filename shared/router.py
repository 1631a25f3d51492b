"""`python -m shared.router`: the Zenoh router that introduces the processes to each other.

With a certificate in TOPNAV_CERTS it is the only way between them and enforces the access rules.
"""

import logging
import os
import sys
from pathlib import Path

import zenoh

from shared.access.credentials import credentials_in
from shared.access.rules import robot_names
from shared.bus import Bus
from shared.lifecycle import configure_logging, stop_on_signals
from shared.transport.router_config import router_config, secured_router_config

log = logging.getLogger(__name__)


def main() -> int:
    """Route until a signal comes; listens on TOPNAV_ROUTER_LISTEN, knows the robots in TOPNAV_ROBOTS."""
    listen = os.environ.get("TOPNAV_ROUTER_LISTEN", "tcp/127.0.0.1:7447")
    configure_logging("router", os.environ.get("TOPNAV_LOG_LEVEL", "INFO"))
    stop = stop_on_signals()
    try:
        config = _config(listen)
        bus = Bus(zenoh.open(config))
    except ValueError as error:
        log.error("%s", error)
        return 1
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


def _config(listen: str) -> zenoh.Config:
    folder = os.environ.get("TOPNAV_CERTS")
    credentials = credentials_in(Path(folder) if folder else None)
    if credentials is None:
        log.info("no certificates: whoever reaches this port takes part")
        return router_config(listen)
    robots = robot_names(os.environ)
    log.info("secured: only holders of a certificate take part; robots %s", ", ".join(robots))
    return secured_router_config(listen, credentials, robots)


if __name__ == "__main__":
    sys.exit(main())
