"""`python -m shared.health SERVICE`: exit 0 when a process of that service is alive on the bus.

It runs every few seconds in every container, so it imports neither messages nor pydantic.
"""

import os
import sys
import threading
from pathlib import Path

import zenoh

from shared.access.credentials import CredentialsError, credentials_in
from shared.transport.keys import alive_key
from shared.transport.session_config import client_config, looker_config

PATIENCE_S = 8.0
"""Chosen: while a service starts, one check waits for it in place of many that ask. What a check takes of the
processor it takes from the services that start: beside 16 busy processes they had too little left."""


def main(arguments: list[str]) -> int:
    """Wait for the service's liveliness token, `PATIENCE_S` at most."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m shared.health SERVICE\n")
        return 2
    service = arguments[0]
    try:
        alive = _is_alive(service)
    except (CredentialsError, zenoh.ZError) as error:
        sys.stderr.write(f"{service}: {error}\n")
        return 1
    if not alive:
        sys.stderr.write(f"{service}: not alive on the bus\n")
    return 0 if alive else 1


def _is_alive(service: str) -> bool:
    endpoint, certs = os.environ.get("TOPNAV_ENDPOINT", "tcp/127.0.0.1:7447"), os.environ.get("TOPNAV_CERTS")
    credentials = credentials_in(Path(certs) if certs else None)
    config = client_config(endpoint, credentials) if credentials else looker_config(endpoint)
    alive = threading.Event()

    def changed(sample: zenoh.Sample) -> None:
        if sample.kind == zenoh.SampleKind.PUT:
            alive.set()

    session = zenoh.open(config)
    try:
        session.liveliness().declare_subscriber(alive_key(service, "*"), changed, history=True)
        return alive.wait(PATIENCE_S)
    finally:
        session.close()  # type: ignore[no-untyped-call]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
